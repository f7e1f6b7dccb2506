// Image aspects of formats.
#pragma once

#include "alcove/framegraph/description.h"

namespace alcove::framegraph {

// Returns all aspects of the format, as an image barrier names them.
inline VkImageAspectFlags aspects(VkFormat format) {
  if (format >= VK_FORMAT_D16_UNORM_S8_UINT && format <= VK_FORMAT_D32_SFLOAT_S8_UINT)
    return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
  if (format == VK_FORMAT_S8_UINT) return VK_IMAGE_ASPECT_STENCIL_BIT;
  const bool is_depth = format >= VK_FORMAT_D16_UNORM && format <= VK_FORMAT_D32_SFLOAT;
  return is_depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

// Returns the aspect that a sampled view shows: depth if the format has depth.
inline VkImageAspectFlags view_aspect(VkFormat format) {
  const VkImageAspectFlags all = aspects(format);
  return all & VK_IMAGE_ASPECT_DEPTH_BIT ? VkImageAspectFlags{VK_IMAGE_ASPECT_DEPTH_BIT} : all;
}

}  // namespace alcove::framegraph
