// A Vulkan handle that is not null, for graphs that are declared and compiled but never recorded.
#pragma once

#include <type_traits>

namespace alcove::framegraph {

template <typename Handle>
Handle fake_handle() {
  static char object = 0;
  // Handles are pointers or integers, by platform.
  if constexpr (std::is_pointer_v<Handle>)
    return reinterpret_cast<Handle>(&object);
  else
    return Handle{1};
}

}  // namespace alcove::framegraph
