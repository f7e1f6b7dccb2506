// The names of Vulkan's formats, for messages.
#pragma once

#include <vulkan/vulkan_core.h>

#include <string>

namespace alcove::passes {

// "VK_FORMAT_R8_UNORM"; a format of an extension by its number.
[[nodiscard]] std::string format_name(VkFormat format);

}  // namespace alcove::passes
