#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "alcove/framegraph/types.h"
#include "gpu/vulkan_device.h"

namespace alcove::sample {

// The stage that waits for an image of the window. Its first barrier must begin with this stage.
inline constexpr VkPipelineStageFlags2 kArrivalStage =
    VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;

// The images of a window of one size. A window that changes its size needs another swapchain. The
// images have 8 bits per channel and no conversion: shaders write sRGB-encoded values.
class Swapchain {
 public:
  // Creates a swapchain. `old`, which may be null, is the previous one and is retired. Errors: the
  // device cannot present to the surface, or the surface has no 8-bit format without conversion.
  [[nodiscard]] static tl::expected<std::unique_ptr<Swapchain>, std::string> create(
      const VulkanDevice& device, VkSurfaceKHR surface, VkExtent2D size,
      std::uint32_t frames_in_flight, std::unique_ptr<Swapchain> old);
  // The device must have finished all frames that use the images.
  ~Swapchain();
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;

  VkExtent2D size() const { return size_; }
  VkFormat format() const { return format_; }

  // Acquires the next image, which becomes the current one. The device may draw to it after the
  // semaphore arrived(slot) is signalled. The previous frame of this slot must be finished. Returns
  // VK_ERROR_OUT_OF_DATE_KHR if the window has changed.
  [[nodiscard]] VkResult acquire(std::uint32_t slot);
  // Returns the current image for import into a graph. Its contents are undefined. Its final state
  // is ready for presentation.
  framegraph::ImportedTexture import() const;
  VkSemaphore arrived(std::uint32_t slot) const { return arrived_[slot]; }
  // The semaphore that the device must signal after it has drawn the current image.
  VkSemaphore drawn() const { return drawn_[current_]; }
  // Presents the current image. Returns VK_SUBOPTIMAL_KHR or VK_ERROR_OUT_OF_DATE_KHR if the window
  // has changed.
  [[nodiscard]] VkResult present() const;

 private:
  explicit Swapchain(const VulkanDevice& device) : device_(device) {}
  VkResult create_views();
  VkResult create_semaphores(std::uint32_t frames_in_flight);

  const VulkanDevice& device_;
  VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
  VkExtent2D size_{};
  VkFormat format_ = VK_FORMAT_UNDEFINED;
  std::vector<VkImage> images_;
  std::vector<VkImageView> views_;
  std::vector<VkSemaphore> arrived_;  // by frame slot
  std::vector<VkSemaphore>
      drawn_;  // by image, because only presentation tells when the semaphore is free again
  std::uint32_t current_ = 0;
};

}  // namespace alcove::sample
