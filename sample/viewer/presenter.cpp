#include "viewer/presenter.h"

#include <utility>

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

}  // namespace

tl::expected<std::unique_ptr<Presenter>, std::string> Presenter::create(Gpu& gpu,
                                                                        const Window& window) {
  std::unique_ptr<Presenter> made(new Presenter(gpu, window));
  auto done = assign(made->surface_, window.create_surface(gpu.device().instance())).and_then([&] {
    return made->create_swapchain();
  });
  if (!done) {
    return Failure(std::move(done.error()));
  }
  return made;
}

tl::expected<void, std::string> Presenter::create_swapchain() {
  wait();
  window_size_ = window_.size();
  acquired_ = false;
  outdated_ = false;
  return assign(swapchain_, Swapchain::create(gpu_.device(), surface_, window_size_,
                                              gpu_.frames_in_flight(), std::move(swapchain_)));
}

Presenter::~Presenter() {
  wait();
  swapchain_.reset();
  vkDestroySurfaceKHR(gpu_.device().instance(), surface_, nullptr);
}

void Presenter::wait() const { vkDeviceWaitIdle(gpu_.device().device()); }

tl::expected<bool, std::string> Presenter::prepare() {
  const VkExtent2D size = window_.size();
  if (size.width == 0 || size.height == 0) {
    return false;
  }
  if (outdated_ || size.width != window_size_.width || size.height != window_size_.height) {
    if (auto made = create_swapchain(); !made) {
      return Failure(std::move(made.error()));
    }
  }
  if (acquired_) {
    return true;
  }
  if (auto waited = gpu_.wait(slot_); !waited) {
    return Failure(std::move(waited.error()));
  }
  timings_.clear();
  for (const framegraph::PassTiming& timing : gpu_.timings(slot_)) {
    timings_.push_back({std::string(timing.name), timing.milliseconds});
  }
  const VkResult result = swapchain_->acquire(slot_);
  acquired_ = result == VK_SUCCESS || result == VK_SUBOPTIMAL_KHR;
  outdated_ = result == VK_SUBOPTIMAL_KHR || result == VK_ERROR_OUT_OF_DATE_KHR;
  if (!acquired_ && !outdated_) {
    return device_failure("get an image of the window", result);
  }
  return acquired_;
}

tl::expected<framegraph::FrameReport, std::string> Presenter::draw(const Declare& declare) {
  const framegraph::QueueSemaphore arrived{.semaphore = swapchain_->arrived(slot_),
                                           .stages = kArrivalStage};
  const framegraph::QueueSemaphore drawn{.semaphore = swapchain_->drawn()};
  auto report = gpu_.submit(
      [&](Graph& graph) {
        return declare(graph, graph.import_texture("window", swapchain_->import()));
      },
      {.slot = slot_, .waits = {&arrived, 1}, .signals = {&drawn, 1}});
  if (!report) {
    return report;
  }
  slot_ = (slot_ + 1) % gpu_.frames_in_flight();
  acquired_ = false;
  const VkResult result = swapchain_->present();
  outdated_ = outdated_ || result == VK_SUBOPTIMAL_KHR || result == VK_ERROR_OUT_OF_DATE_KHR;
  if (!outdated_ && result != VK_SUCCESS) {
    return device_failure("present a frame", result);
  }
  return report;
}

}  // namespace alcove::sample
