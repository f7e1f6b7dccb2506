#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>

#include "alcove/framegraph/types.h"
#include "gpu/vulkan_device.h"

namespace alcove::sample {

// An image with memory and a view of its own (of all its mips), that lives from frame to frame. The
// graph imports it; between frames it rests in the state that it was left in.
class GpuImage {
 public:
  [[nodiscard]] static tl::expected<std::unique_ptr<GpuImage>, std::string> create(
      const VulkanDevice& device, VkFormat format, VkExtent2D size, VkImageUsageFlags usage,
      std::uint32_t mips = 1);
  ~GpuImage();
  GpuImage(const GpuImage&) = delete;
  GpuImage& operator=(const GpuImage&) = delete;

  VkImageView view() const { return view_; }
  std::uint32_t mips() const { return mips_; }

  // For a frame that fills the image, whatever it holds, and leaves it in `final_state`.
  framegraph::ImportedTexture import_to_fill(framegraph::State final_state) const;
  // For a frame that finds it in `initial_state`, reads it, and leaves it there.
  framegraph::ImportedTexture import_to_read(framegraph::State initial_state) const;

 private:
  explicit GpuImage(const VulkanDevice& device) : device_(device) {}
  framegraph::ImportedTexture import() const;

  const VulkanDevice& device_;
  VkImage image_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  VkImageView view_ = VK_NULL_HANDLE;
  VkFormat format_ = VK_FORMAT_UNDEFINED;
  VkExtent2D size_{};
  std::uint32_t mips_ = 1;
  VkImageUsageFlags usage_ = 0;
};

// Sampled by fragment and by compute shaders: how the sample's images rest between frames.
inline constexpr framegraph::State kSampledState{
    VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
    VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};

// The aspect of an image of this format: depth or colour.
[[nodiscard]] VkImageAspectFlags aspect_of(VkFormat format);

}  // namespace alcove::sample
