// Estimates of the memory that resources take, for plans without a device.
#include <algorithm>
#include <array>
#include <cstddef>

#include "alcove/framegraph/compile.h"

namespace alcove::framegraph {
namespace {

// Returns the bytes per texel of a format. Block-compressed formats count as 1 byte per texel,
// which none of them exceeds. Formats that are not listed count as 16, because an estimate must not
// be too small.
constexpr std::uint32_t find_texel_size(VkFormat format) {
  const auto in = [format](VkFormat first, VkFormat last) {
    return format >= first && format <= last;
  };
  if (in(VK_FORMAT_R4G4_UNORM_PACK8, VK_FORMAT_R4G4_UNORM_PACK8)) return 1;
  if (in(VK_FORMAT_R4G4B4A4_UNORM_PACK16, VK_FORMAT_A1R5G5B5_UNORM_PACK16)) return 2;
  if (in(VK_FORMAT_R8_UNORM, VK_FORMAT_R8_SRGB)) return 1;
  if (in(VK_FORMAT_R8G8_UNORM, VK_FORMAT_R8G8_SRGB)) return 2;
  if (in(VK_FORMAT_R8G8B8_UNORM, VK_FORMAT_B8G8R8_SRGB)) return 3;
  if (in(VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_A2B10G10R10_SINT_PACK32)) return 4;
  if (in(VK_FORMAT_R16_UNORM, VK_FORMAT_R16_SFLOAT)) return 2;
  if (in(VK_FORMAT_R16G16_UNORM, VK_FORMAT_R16G16_SFLOAT)) return 4;
  if (in(VK_FORMAT_R16G16B16_UNORM, VK_FORMAT_R16G16B16_SFLOAT)) return 6;
  if (in(VK_FORMAT_R16G16B16A16_UNORM, VK_FORMAT_R16G16B16A16_SFLOAT)) return 8;
  if (in(VK_FORMAT_R32_UINT, VK_FORMAT_R32_SFLOAT)) return 4;
  if (in(VK_FORMAT_R32G32_UINT, VK_FORMAT_R32G32_SFLOAT)) return 8;
  if (in(VK_FORMAT_R32G32B32_UINT, VK_FORMAT_R32G32B32_SFLOAT)) return 12;
  if (in(VK_FORMAT_R64_UINT, VK_FORMAT_R64_SFLOAT)) return 8;
  if (in(VK_FORMAT_R64G64B64_UINT, VK_FORMAT_R64G64B64_SFLOAT)) return 24;
  if (in(VK_FORMAT_R64G64B64A64_UINT, VK_FORMAT_R64G64B64A64_SFLOAT)) return 32;
  if (in(VK_FORMAT_B10G11R11_UFLOAT_PACK32, VK_FORMAT_E5B9G9R9_UFLOAT_PACK32)) return 4;
  switch (format) {
    case VK_FORMAT_D16_UNORM:
      return 2;
    case VK_FORMAT_X8_D24_UNORM_PACK32:
    case VK_FORMAT_D32_SFLOAT:
    case VK_FORMAT_D24_UNORM_S8_UINT:
      return 4;
    case VK_FORMAT_S8_UINT:
      return 1;
    case VK_FORMAT_D16_UNORM_S8_UINT:
      return 3;
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
      return 5;
    default:
      break;
  }
  if (in(VK_FORMAT_BC1_RGB_UNORM_BLOCK, VK_FORMAT_ASTC_12x12_SRGB_BLOCK)) return 1;
  return 16;
}

// Bytes per texel, indexed by format, for the formats of Vulkan 1.0.
constexpr auto kTexelSizes = [] {
  std::array<std::uint8_t, VK_FORMAT_ASTC_12x12_SRGB_BLOCK + 1> sizes{};
  for (std::size_t i = 0; i < sizes.size(); ++i)
    sizes[i] = static_cast<std::uint8_t>(find_texel_size(static_cast<VkFormat>(i)));
  return sizes;
}();

inline std::uint32_t texel_size(VkFormat format) {
  const auto index = static_cast<std::size_t>(format);
  return index < kTexelSizes.size() ? kTexelSizes[index] : find_texel_size(format);
}

}  // namespace

MemoryRequirements estimate_requirements(const ResourceRecord& record) {
  constexpr VkDeviceSize kAlignment = 256;
  VkDeviceSize size = record.size;
  if (record.kind == ResourceKind::texture) {
    size = VkDeviceSize{record.width} * record.height * record.depth;
    for (std::uint32_t mip = 1; mip < record.mips; ++mip) {
      const auto side = [mip](std::uint32_t length) {
        return VkDeviceSize{mip < 32 ? std::max(1u, length >> mip) : 1u};
      };
      size += side(record.width) * side(record.height) * side(record.depth);
    }
    size *= VkDeviceSize{texel_size(record.format)} * record.layers * record.samples;
  }
  return {(size + kAlignment - 1) & ~(kAlignment - 1), kAlignment, ~0u};
}

}  // namespace alcove::framegraph
