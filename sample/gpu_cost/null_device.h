// A Vulkan device without a GPU: Mesa's RADV driver compiles pipelines for any AMD GPU.
#pragma once

#include <vulkan/vulkan.h>

#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace alcove::sample {

// Creates pipelines and nothing else. The driver cannot destroy such a device, so its handles live
// until the process ends.
struct NullDevice {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  std::string name;
};

// `family` is a GPU family as RADV_FORCE_FAMILY names it. Sets environment variables of this
// process while the device is created, which no other thread may read meanwhile. Errors: the driver
// is not installed, or does not support the family.
[[nodiscard]] tl::expected<NullDevice, std::string> create_null_device(std::string_view family);

}  // namespace alcove::sample
