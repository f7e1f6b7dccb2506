// Vulkan handles that are not null, for graphs that are declared and compiled but never recorded.
#pragma once

#include <cstddef>
#include <type_traits>

namespace alcove::framegraph {

// Handles of different numbers, up to 255, are different.
template <typename Handle>
Handle fake_handle(std::size_t number = 0) {
  static char objects[256] = {};
  // Handles are pointers or integers, by platform.
  if constexpr (std::is_pointer_v<Handle>)
    return reinterpret_cast<Handle>(&objects[number % 256]);
  else
    return Handle{1 + number % 256};
}

}  // namespace alcove::framegraph
