// The source of the normals that the occlusion passes use.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace alcove::sample {

enum class NormalSource {
  shading,    // The g-buffer's interpolated normals, with normal maps.
  geometric,  // The g-buffer's flat triangle normals.
  depth,      // None are given: the library reconstructs them from the depth buffer.
};

// Names of the enumerators, in their order.
inline constexpr std::array<std::string_view, 3> kNormalSourceNames{"shading", "geometric",
                                                                    "depth"};

constexpr std::string_view name_of(NormalSource source) {
  return kNormalSourceNames[static_cast<std::size_t>(source)];
}

}  // namespace alcove::sample
