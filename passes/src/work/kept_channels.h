// Formats of which one channel can be replaced without a change of the others.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>

namespace alcove::passes {

// Returns the number of channels of a format if a shader can read a texel and write it back without
// changing a bit, and otherwise 0. (In float formats, a NaN may change its bits and a denormal
// number may become 0.) Signed normalised formats do not qualify, because they have two codes for
// -1. Formats with sRGB or a shared exponent do not qualify, because they round.
[[nodiscard]] constexpr std::uint32_t kept_channels(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R8_UNORM:
    case VK_FORMAT_R16_UNORM:
    case VK_FORMAT_R16_SFLOAT:
    case VK_FORMAT_R32_SFLOAT:
      return 1;
    case VK_FORMAT_R8G8_UNORM:
    case VK_FORMAT_R16G16_UNORM:
    case VK_FORMAT_R16G16_SFLOAT:
    case VK_FORMAT_R32G32_SFLOAT:
      return 2;
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_B8G8R8A8_UNORM:
    case VK_FORMAT_A8B8G8R8_UNORM_PACK32:
    case VK_FORMAT_A2R10G10B10_UNORM_PACK32:
    case VK_FORMAT_A2B10G10R10_UNORM_PACK32:
    case VK_FORMAT_R16G16B16A16_UNORM:
    case VK_FORMAT_R16G16B16A16_SFLOAT:
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return 4;
    default:
      return 0;
  }
}

// The formats for which kept_channels() is not 0, for sentences of errors.
inline constexpr const char* kKeptFormats =
    "give an unsigned normalised or float format that has the channel, such as "
    "VK_FORMAT_R8G8B8A8_UNORM";

}  // namespace alcove::passes
