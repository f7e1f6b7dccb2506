// The names of Vulkan's formats, for messages.
#pragma once

#include <vulkan/vulkan_core.h>

#include <string>

namespace alcove::passes {

// Returns the name of a format, for example "VK_FORMAT_R8_UNORM". A format of an extension is named
// by its number.
[[nodiscard]] std::string format_name(VkFormat format);

}  // namespace alcove::passes
