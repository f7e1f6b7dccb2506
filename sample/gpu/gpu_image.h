#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>

#include "alcove/framegraph/types.h"
#include "gpu/vulkan_device.h"

namespace alcove::sample {

// A 2D image with its own device memory, which keeps its contents from frame to frame. It has a
// view of all mips and layers if its usage allows one. A graph imports the image. Between frames it
// stays in the state in which the last frame left it.
class GpuImage {
 public:
  // The extent of `desc` is absolute. Errors say in one sentence why the device refused.
  [[nodiscard]] static tl::expected<std::unique_ptr<GpuImage>, std::string> create(
      const VulkanDevice& device, const framegraph::TextureDesc& desc, VkImageUsageFlags usage);
  ~GpuImage();
  GpuImage(const GpuImage&) = delete;
  GpuImage& operator=(const GpuImage&) = delete;

  VkImage image() const { return image_; }
  VkImageView view() const { return view_; }  // null if the usage allows none
  std::uint32_t mips() const { return desc_.mips; }

  // Returns the import for a frame that overwrites the image and leaves it in `final_state`, which
  // is also the state, if any, in which the frame before left it.
  framegraph::ImportedTexture import_to_fill(framegraph::State final_state) const;
  // Returns the import for a frame that finds the image in `initial_state`, reads it, and leaves it
  // in that state.
  framegraph::ImportedTexture import_to_read(framegraph::State initial_state) const;

 private:
  explicit GpuImage(const VulkanDevice& device) : device_(device) {}
  framegraph::ImportedTexture import() const;

  const VulkanDevice& device_;
  VkImage image_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  VkImageView view_ = VK_NULL_HANDLE;
  framegraph::TextureDesc desc_;
  VkImageUsageFlags usage_ = 0;
};

// The state of the sample's images between frames: sampled by fragment and compute shaders.
inline constexpr framegraph::State kSampledState{
    VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
    VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};

// Returns the aspect that shaders read of an image of this format: depth or colour.
[[nodiscard]] VkImageAspectFlags aspect_of(VkFormat format);

}  // namespace alcove::sample
