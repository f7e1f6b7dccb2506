#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "alcove/framegraph/types.h"
#include "gpu/vulkan_device.h"

namespace alcove::sample {

// The images of a window, of one size: another size, another swapchain. Eight bits a channel that
// are shown as they are written: who draws encodes sRGB.
class Swapchain {
 public:
  // `old` is taken over and may be null. Errors: a surface that the device cannot present to, or
  // that has no format of that kind.
  [[nodiscard]] static tl::expected<std::unique_ptr<Swapchain>, std::string> create(
      const VulkanDevice& device, VkSurfaceKHR surface, VkExtent2D size,
      std::uint32_t frames_in_flight, std::unique_ptr<Swapchain> old);
  // The device must have finished with it.
  ~Swapchain();
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;

  VkExtent2D size() const { return size_; }
  VkFormat format() const { return format_; }

  // Makes the next image the current one. The device may draw on it once arrived(slot) is
  // signalled, whose last use it must have finished. VK_ERROR_OUT_OF_DATE_KHR: the window has
  // changed.
  [[nodiscard]] VkResult acquire(std::uint32_t slot);
  // The current image as a graph imports it: without contents, to be left ready to present.
  framegraph::ImportedTexture import() const;
  VkSemaphore arrived(std::uint32_t slot) const { return arrived_[slot]; }
  // What the device must signal once it has drawn the current image.
  VkSemaphore drawn() const { return drawn_[current_]; }
  // VK_SUBOPTIMAL_KHR and VK_ERROR_OUT_OF_DATE_KHR: the window has changed.
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
  std::vector<VkSemaphore> drawn_;    // by image: presentation is the only one to know when it ends
  std::uint32_t current_ = 0;
};

}  // namespace alcove::sample
