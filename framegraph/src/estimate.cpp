// Estimates of the memory that resources take, for plans without a device.
#include <algorithm>
#include <array>
#include <cstddef>

#include "alcove/framegraph/compile.h"

namespace alcove::framegraph {
namespace {

// Bytes per texel, indexed by format, for the formats of Vulkan 1.0. Block-compressed formats count
// as 1 byte per texel, which none of them exceeds.
constexpr auto kTexelSizes = [] {
  struct Run {
    VkFormat first;  // the run ends before the first format of the next one
    std::uint8_t bytes;
  };
  constexpr Run kRuns[] = {{VK_FORMAT_R4G4_UNORM_PACK8, 1},
                           {VK_FORMAT_R4G4B4A4_UNORM_PACK16, 2},
                           {VK_FORMAT_R8_UNORM, 1},
                           {VK_FORMAT_R8G8_UNORM, 2},
                           {VK_FORMAT_R8G8B8_UNORM, 3},
                           {VK_FORMAT_R8G8B8A8_UNORM, 4},
                           {VK_FORMAT_R16_UNORM, 2},
                           {VK_FORMAT_R16G16_UNORM, 4},
                           {VK_FORMAT_R16G16B16_UNORM, 6},
                           {VK_FORMAT_R16G16B16A16_UNORM, 8},
                           {VK_FORMAT_R32_UINT, 4},
                           {VK_FORMAT_R32G32_UINT, 8},
                           {VK_FORMAT_R32G32B32_UINT, 12},
                           {VK_FORMAT_R32G32B32A32_UINT, 16},
                           {VK_FORMAT_R64_UINT, 8},
                           {VK_FORMAT_R64G64_UINT, 16},
                           {VK_FORMAT_R64G64B64_UINT, 24},
                           {VK_FORMAT_R64G64B64A64_UINT, 32},
                           {VK_FORMAT_B10G11R11_UFLOAT_PACK32, 4},
                           {VK_FORMAT_D16_UNORM, 2},
                           {VK_FORMAT_X8_D24_UNORM_PACK32, 4},
                           {VK_FORMAT_S8_UINT, 1},
                           {VK_FORMAT_D16_UNORM_S8_UINT, 3},
                           {VK_FORMAT_D24_UNORM_S8_UINT, 4},
                           {VK_FORMAT_D32_SFLOAT_S8_UINT, 5},
                           {VK_FORMAT_BC1_RGB_UNORM_BLOCK, 1}};
  std::array<std::uint8_t, VK_FORMAT_ASTC_12x12_SRGB_BLOCK + 1> sizes{};
  for (const Run& run : kRuns) {
    for (std::size_t i = run.first; i < sizes.size(); ++i) sizes[i] = run.bytes;
  }
  return sizes;
}();

}  // namespace

MemoryRequirements estimate_requirements(const ResourceRecord& record) {
  constexpr VkDeviceSize kAlignment = 256;
  VkDeviceSize size = record.size;
  if (record.kind == ResourceKind::texture) {
    for (std::uint32_t mip = 0; mip < record.mips && mip < 32; ++mip) {
      const auto side = [mip](std::uint32_t length) {
        return VkDeviceSize{std::max(1u, length >> mip)};
      };
      size += side(record.width) * side(record.height) * side(record.depth);
    }
    // Formats of extensions count as 16 bytes, because an estimate must not be too small.
    const auto format = static_cast<std::size_t>(record.format);
    const VkDeviceSize texel = format < kTexelSizes.size() ? kTexelSizes[format] : 16;
    size *= texel * record.layers * record.samples;
  }
  return {(size + kAlignment - 1) & ~(kAlignment - 1), kAlignment, ~0u};
}

}  // namespace alcove::framegraph
