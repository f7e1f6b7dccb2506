#pragma once

#include <functional>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "gpu/gpu.h"
#include "viewer/swapchain.h"
#include "viewer/window.h"

namespace alcove::sample {

// Draws frames into a window, as many in flight as the Gpu has.
class Presenter {
 public:
  // Both must outlive the presenter.
  [[nodiscard]] static tl::expected<std::unique_ptr<Presenter>, std::string> create(
      Gpu& gpu, const Window& window);
  ~Presenter();
  Presenter(const Presenter&) = delete;
  Presenter& operator=(const Presenter&) = delete;

  // Follows the size of the window. False: there is nothing to draw on, the window is minimised.
  [[nodiscard]] tl::expected<bool, std::string> prepare();
  VkExtent2D size() const { return swapchain_->size(); }
  VkFormat format() const { return swapchain_->format(); }

  // After prepare(): declares a frame that draws `target`, all of it, submits and presents it.
  // After an error of `declare` or of the graph another frame can be tried.
  using Declare = std::function<tl::expected<void, std::string>(framegraph::Graph&,
                                                                framegraph::Texture target)>;
  [[nodiscard]] tl::expected<framegraph::FrameReport, std::string> draw(const Declare& declare);
  // Of the frame that the device finished last.
  const std::vector<PassTime>& timings() const { return timings_; }

  // Waits until all is drawn.
  void wait() const;

 private:
  struct Slot {
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence finished = VK_NULL_HANDLE;
  };
  Presenter(Gpu& gpu, const Window& window) : gpu_(gpu), window_(window) {}
  tl::expected<void, std::string> create_slots();
  tl::expected<void, std::string> create_swapchain();
  // Waits for the frame that had the next one's slot and takes its timings.
  VkResult wait_for_slot();
  VkResult submit(const Slot& slot) const;

  Gpu& gpu_;
  const Window& window_;
  VkSurfaceKHR surface_ = VK_NULL_HANDLE;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  std::unique_ptr<Swapchain> swapchain_;
  VkExtent2D window_size_{};  // that it was made for
  std::vector<Slot> slots_;
  std::uint32_t slot_ = 0;  // of the next frame
  bool acquired_ = false;   // the swapchain has an image for it
  bool outdated_ = false;   // the window is no longer what the swapchain was made for
  std::vector<PassTime> timings_;
};

}  // namespace alcove::sample
