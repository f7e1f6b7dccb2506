// The formats of results by their precision.
#pragma once

#include "alcove/passes/frame.h"

namespace alcove::passes {

[[nodiscard]] inline VkFormat scalar_format(Precision precision) {
  switch (precision) {
    case Precision::unorm8:
      return VK_FORMAT_R8_UNORM;
    case Precision::float16:
      return VK_FORMAT_R16_SFLOAT;
    default:
      return VK_FORMAT_R32_SFLOAT;
  }
}

// Colours from 0 to 1.
[[nodiscard]] inline VkFormat colour_format(Precision precision) {
  switch (precision) {
    case Precision::unorm8:
      return VK_FORMAT_R8G8B8A8_UNORM;
    case Precision::float16:
      return VK_FORMAT_R16G16B16A16_SFLOAT;
    default:
      return VK_FORMAT_R32G32B32A32_SFLOAT;
  }
}

// Unit vectors.
[[nodiscard]] inline VkFormat direction_format(Precision precision) {
  return precision == Precision::unorm8 ? VK_FORMAT_R8G8B8A8_SNORM : colour_format(precision);
}

// What a search leaves, and its history: two words, and two more for a lobe.
[[nodiscard]] inline VkFormat raw_format(bool lobe) {
  return lobe ? VK_FORMAT_R32G32B32A32_UINT : VK_FORMAT_R32G32_UINT;
}
inline constexpr VkFormat kBentRawFormat = VK_FORMAT_R32G32_UINT;

// Bytes a pixel of all textures of a history, as add_reconstruct() declares them: two of
// raw_format() and, with bent normals, two of RGBA16_SFLOAT.
[[nodiscard]] inline std::uint64_t history_bytes(bool lobe, bool bent) {
  return 2u * ((lobe ? 16u : 8u) + (bent ? 8u : 0u));
}

}  // namespace alcove::passes
