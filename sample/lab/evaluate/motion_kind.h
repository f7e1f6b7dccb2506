// The camera and object paths that `alcove motion` measures.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace alcove::sample {

enum class MotionKind : std::uint8_t {
  orbit,   // The camera orbits a point in the middle of the view at the median surface depth.
  dolly,   // The camera moves towards that point.
  strafe,  // The camera moves to the right, past a column that is added near the eye.
  object,  // The camera is static and an added object slides over the ground.
  cut,     // The camera is static and jumps to another place in the middle of the path.
};

inline constexpr std::array kMotionKinds{MotionKind::orbit, MotionKind::dolly, MotionKind::strafe,
                                         MotionKind::object, MotionKind::cut};

// Names in the order of the enumerators.
inline constexpr std::array<std::string_view, 5> kMotionKindNames{"orbit", "dolly", "strafe",
                                                                  "object", "cut"};

constexpr std::string_view name_of(MotionKind kind) {
  return kMotionKindNames[static_cast<std::size_t>(kind)];
}

}  // namespace alcove::sample
