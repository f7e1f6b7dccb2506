// Makes Vulkan handles that are not null, for graphs that are declared and compiled but never
// recorded.
#pragma once

#include <cstddef>
#include <type_traits>

namespace alcove::framegraph {

// Returns the handle with a number up to 255. Different numbers give different handles.
template <typename Handle>
Handle fake_handle(std::size_t number = 0) {
  static char objects[256] = {};
  // A handle is a pointer or an integer, depending on the platform.
  if constexpr (std::is_pointer_v<Handle>)
    return reinterpret_cast<Handle>(&objects[number % 256]);
  else
    return Handle{1 + number % 256};
}

}  // namespace alcove::framegraph
