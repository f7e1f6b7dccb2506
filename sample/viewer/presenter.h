#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "gpu/gpu.h"
#include "support/result.h"
#include "viewer/window.h"

namespace alcove::sample {

// Draws frames into a window, whose images have 8 bits per channel and no conversion: shaders write
// sRGB-encoded values. The number of frames in flight is that of the Gpu.
class Presenter {
 public:
  // Gpu and window must outlive the presenter.
  [[nodiscard]] static Result<std::unique_ptr<Presenter>> create(Gpu& gpu, const Window& window);
  ~Presenter();
  Presenter(const Presenter&) = delete;
  Presenter& operator=(const Presenter&) = delete;

  // Creates a new swapchain if the size of the window has changed, waits for the frame's slot, and
  // acquires an image. Returns false if no frame can be drawn now, because the window is minimised
  // or the next call has to create a new swapchain.
  [[nodiscard]] Result<bool> prepare();
  VkExtent2D size() const { return size_; }
  VkFormat format() const { return format_; }

  // Declares, submits and presents a frame that draws all of `target`. `declare` returns the passes
  // that PassTime::of_view marks. Call it after prepare(). After an error of `declare` or of the
  // graph, another frame may be drawn.
  using Declare = std::function<Result<PassRange>(framegraph::Graph&, framegraph::Texture target)>;
  [[nodiscard]] Result<framegraph::FrameReport> draw(const Declare& declare);
  // Returns the times of the last frame that the device has finished.
  const std::vector<PassTime>& timings() const { return timings_; }

  // Waits until the device has finished all frames.
  void wait() const;

 private:
  Presenter(Gpu& gpu, const Window& window)
      : gpu_(gpu), window_(window), view_passes_(gpu.frames_in_flight()) {}
  // Creates the images of a window of its current size. Errors: the device cannot present to the
  // surface, or the surface has no 8-bit format without conversion.
  Result<void> create_swapchain();
  VkResult create_images();
  void destroy_images();

  Gpu& gpu_;
  const Window& window_;
  VkSurfaceKHR surface_ = VK_NULL_HANDLE;
  VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
  VkExtent2D size_{};
  VkFormat format_ = VK_FORMAT_UNDEFINED;
  std::vector<VkImage> images_;
  std::vector<VkImageView> views_;
  std::vector<VkSemaphore> arrived_;  // by frame slot
  // By image, because only presentation tells when the semaphore is free again.
  std::vector<VkSemaphore> drawn_;
  std::uint32_t current_ = 0;           // index of the acquired image
  VkExtent2D window_size_{};            // the size that the swapchain was made for
  std::uint32_t slot_ = 0;              // slot of the next frame
  bool acquired_ = false;               // the swapchain has an image for it
  bool outdated_ = false;               // the swapchain no longer suits the window
  std::vector<PassRange> view_passes_;  // by frame slot
  std::vector<PassTime> timings_;
};

}  // namespace alcove::sample
