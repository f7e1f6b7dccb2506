// A Vulkan device without a GPU: Mesa's RADV driver compiles pipelines for any AMD GPU.
#pragma once

#include <vulkan/vulkan.h>

#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace alcove::sample {

// A device that can create pipelines and do nothing else. The driver cannot destroy it, so its
// handles live until the process ends.
struct NullDevice {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  std::string name;
};

// Creates a device of the GPU family `family`, named as in the environment variable
// RADV_FORCE_FAMILY. Environment variables of this process are set during the call, and no other
// thread may read them meanwhile. Errors: the driver is not installed, or does not support the
// family.
[[nodiscard]] tl::expected<NullDevice, std::string> create_null_device(std::string_view family);

}  // namespace alcove::sample
