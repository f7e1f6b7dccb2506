#include "viewer/presenter.h"

#include <utility>

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

}  // namespace

tl::expected<std::unique_ptr<Presenter>, std::string> Presenter::create(Gpu& gpu,
                                                                        const Window& window) {
  std::unique_ptr<Presenter> made(new Presenter(gpu, window));
  auto surface = window.create_surface(gpu.device().instance());
  if (!surface) {
    return Failure(std::move(surface.error()));
  }
  made->surface_ = *surface;
  auto done = made->create_slots().and_then([&] { return made->create_swapchain(); });
  if (!done) {
    return Failure(std::move(done.error()));
  }
  return made;
}

tl::expected<void, std::string> Presenter::create_slots() {
  const VkDevice device = gpu_.device().device();
  slots_.resize(gpu_.frames_in_flight());
  const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                     .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                     .queueFamilyIndex = gpu_.device().queue_family()};
  VkResult result = vkCreateCommandPool(device, &pool, nullptr, &pool_);
  for (Slot& slot : slots_) {
    const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                           .commandPool = pool_,
                                           .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                           .commandBufferCount = 1};
    if (result == VK_SUCCESS) {
      result = vkAllocateCommandBuffers(device, &info, &slot.commands);
    }
    const VkFenceCreateInfo fence{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO,
                                  .flags = VK_FENCE_CREATE_SIGNALED_BIT};
    if (result == VK_SUCCESS) {
      result = vkCreateFence(device, &fence, nullptr, &slot.finished);
    }
  }
  if (result != VK_SUCCESS) {
    return device_failure("create the commands of a frame", result);
  }
  return {};
}

tl::expected<void, std::string> Presenter::create_swapchain() {
  wait();
  window_size_ = window_.size();
  auto made = Swapchain::create(gpu_.device(), surface_, window_size_, gpu_.frames_in_flight(),
                                std::move(swapchain_));
  if (!made) {
    return Failure(std::move(made.error()));
  }
  swapchain_ = std::move(*made);
  acquired_ = false;
  outdated_ = false;
  return {};
}

Presenter::~Presenter() {
  wait();
  const VkDevice device = gpu_.device().device();
  for (const Slot& slot : slots_) {
    vkDestroyFence(device, slot.finished, nullptr);
  }
  vkDestroyCommandPool(device, pool_, nullptr);
  swapchain_.reset();
  vkDestroySurfaceKHR(gpu_.device().instance(), surface_, nullptr);
}

void Presenter::wait() const { vkDeviceWaitIdle(gpu_.device().device()); }

VkResult Presenter::wait_for_slot() {
  const VkResult result =
      vkWaitForFences(gpu_.device().device(), 1, &slots_[slot_].finished, VK_TRUE, UINT64_MAX);
  if (result == VK_SUCCESS) {
    timings_.clear();
    for (const framegraph::PassTiming& timing : gpu_.executor().timings(slot_)) {
      timings_.push_back({std::string(timing.name), timing.milliseconds});
    }
  }
  return result;
}

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
  VkResult result = wait_for_slot();
  if (result == VK_SUCCESS) {
    result = swapchain_->acquire(slot_);
  }
  switch (result) {
    case VK_SUBOPTIMAL_KHR:  // there is an image all the same
      outdated_ = true;
      [[fallthrough]];
    case VK_SUCCESS:
      acquired_ = true;
      return true;
    case VK_ERROR_OUT_OF_DATE_KHR:
      outdated_ = true;
      return false;
    default:
      return device_failure("get an image of the window", result);
  }
}

tl::expected<framegraph::FrameReport, std::string> Presenter::draw(const Declare& declare) {
  const Slot& slot = slots_[slot_];
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                       .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  VkResult result = vkBeginCommandBuffer(slot.commands, &begin);
  if (result != VK_SUCCESS) {
    return device_failure("begin a frame's commands", result);
  }
  auto report = gpu_.record(
      [&](Graph& graph) {
        return declare(graph, graph.import_texture("window", swapchain_->import()));
      },
      slot.commands, slot_);
  result = vkEndCommandBuffer(slot.commands);
  if (!report) {
    return report;
  }
  if (result == VK_SUCCESS) {
    result = submit(slot);
  }
  if (result != VK_SUCCESS) {
    return device_failure("run a frame", result);
  }
  slot_ = (slot_ + 1) % gpu_.frames_in_flight();
  acquired_ = false;
  result = swapchain_->present();
  if (result == VK_SUBOPTIMAL_KHR || result == VK_ERROR_OUT_OF_DATE_KHR) {
    outdated_ = true;
  } else if (result != VK_SUCCESS) {
    return device_failure("present a frame", result);
  }
  return report;
}

VkResult Presenter::submit(const Slot& slot) const {
  const VkSemaphoreSubmitInfo arrived{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                      .semaphore = swapchain_->arrived(slot_),
                                      .stageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT};
  const VkSemaphoreSubmitInfo drawn{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                    .semaphore = swapchain_->drawn(),
                                    .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT};
  const VkCommandBufferSubmitInfo commands{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                           .commandBuffer = slot.commands};
  const VkSubmitInfo2 info{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                           .waitSemaphoreInfoCount = 1,
                           .pWaitSemaphoreInfos = &arrived,
                           .commandBufferInfoCount = 1,
                           .pCommandBufferInfos = &commands,
                           .signalSemaphoreInfoCount = 1,
                           .pSignalSemaphoreInfos = &drawn};
  const VkResult result = vkResetFences(gpu_.device().device(), 1, &slot.finished);
  return result == VK_SUCCESS ? vkQueueSubmit2(gpu_.device().queue(), 1, &info, slot.finished)
                              : result;
}

}  // namespace alcove::sample
