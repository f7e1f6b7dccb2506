// The formats of intermediate results.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>

namespace alcove::passes {

// Returns the format of the raw occlusion that gtao.comp writes (maths/raw_occlusion.h).
[[nodiscard]] inline VkFormat raw_format(bool lobe) {
  return lobe ? VK_FORMAT_R32G32B32A32_UINT : VK_FORMAT_R32G32_UINT;
}
inline constexpr VkFormat kBentRawFormat = VK_FORMAT_R32G32_UINT;

// The formats of histories: of visibility (maths::pack_history_texel), of bent normals
// (maths::pack_half_residual) and of GGX lobes (maths::pack_lobe_texel).
inline constexpr VkFormat kHistoryFormat = VK_FORMAT_R16G16_UNORM;
inline constexpr VkFormat kBentHistoryFormat = VK_FORMAT_A2B10G10R10_UNORM_PACK32;
inline constexpr VkFormat kLobeHistoryFormat = VK_FORMAT_R16_UINT;

// The formats of histories at half resolution, which the upsampling pass also reads:
// maths::pack_half_texel() and maths::half_texel_depth().
inline constexpr VkFormat kHalfFormat = VK_FORMAT_R16G16B16A16_SNORM;
inline constexpr VkFormat kHalfDepthFormat = VK_FORMAT_R32_SFLOAT;

// Returns the bytes per texel of a format that the passes create.
[[nodiscard]] inline std::uint64_t texel_bytes(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R8_UNORM:
      return 1;
    case VK_FORMAT_R16_SFLOAT:
    case VK_FORMAT_R16_UINT:
      return 2;
    case VK_FORMAT_R32_SFLOAT:
    case VK_FORMAT_R8G8B8A8_SNORM:
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_R16G16_UNORM:
    case VK_FORMAT_A2B10G10R10_UNORM_PACK32:
      return 4;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
    case VK_FORMAT_R16G16B16A16_SNORM:
    case VK_FORMAT_R32G32_UINT:
      return 8;
    default:
      return 16;
  }
}

}  // namespace alcove::passes
