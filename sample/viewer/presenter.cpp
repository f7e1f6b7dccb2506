#include "viewer/presenter.h"

#include <algorithm>

#include "alcove/framegraph/access.h"

namespace alcove::sample {
namespace {

// The stage that waits for an image of the window. Its first barrier must begin with this stage.
constexpr VkPipelineStageFlags2 kArrivalStage = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;

// The images are drawn by a pass, and copied for screenshots.
constexpr VkImageUsageFlags kUsage =
    VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;

VkSurfaceFormatKHR choose_format(VkPhysicalDevice device, VkSurfaceKHR surface) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceSurfaceFormatsKHR(device, surface, &count, nullptr);
  std::vector<VkSurfaceFormatKHR> formats(count);
  vkGetPhysicalDeviceSurfaceFormatsKHR(device, surface, &count, formats.data());
  const auto fits = [](const VkSurfaceFormatKHR& format) {
    return (format.format == VK_FORMAT_B8G8R8A8_UNORM ||
            format.format == VK_FORMAT_R8G8B8A8_UNORM) &&
           format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;
  };
  const auto found = std::ranges::find_if(formats, fits);
  return found == formats.end() ? VkSurfaceFormatKHR{VK_FORMAT_UNDEFINED} : *found;
}

// Returns the size of the images. If the window system prescribes none, it is the wanted size,
// clamped to the limits.
VkExtent2D choose_size(const VkSurfaceCapabilitiesKHR& can, VkExtent2D wanted) {
  if (can.currentExtent.width != UINT32_MAX) return can.currentExtent;
  return {std::clamp(wanted.width, can.minImageExtent.width, can.maxImageExtent.width),
          std::clamp(wanted.height, can.minImageExtent.height, can.maxImageExtent.height)};
}

// Returns one more than the least number of images, so that one can be drawn while another waits to
// be shown.
std::uint32_t choose_count(const VkSurfaceCapabilitiesKHR& can) {
  const std::uint32_t most = can.maxImageCount == 0 ? UINT32_MAX : can.maxImageCount;
  return std::min(can.minImageCount + 1, most);
}

}  // namespace

Result<std::unique_ptr<Presenter>> Presenter::create(Gpu& gpu, const Window& window) {
  std::unique_ptr<Presenter> made(new Presenter(gpu, window));
  ALCOVE_TRY(made->surface_, window.create_surface(gpu.device().instance()));
  ALCOVE_TRY_VOID(made->create_swapchain());
  return made;
}

Result<void> Presenter::create_swapchain() {
  wait();
  destroy_images();
  window_size_ = window_.size();
  acquired_ = false;
  outdated_ = false;
  const VulkanDevice& device = gpu_.device();
  VkBool32 supported = VK_FALSE;
  vkGetPhysicalDeviceSurfaceSupportKHR(device.physical_device(), device.queue_family(), surface_,
                                       &supported);
  if (supported == VK_FALSE) {
    return Failure(std::string(device.properties().deviceName) +
                   " cannot present to this display; `alcove render` needs none.");
  }
  VkSurfaceCapabilitiesKHR can{};
  VkResult result =
      vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device.physical_device(), surface_, &can);
  const VkSurfaceFormatKHR format = choose_format(device.physical_device(), surface_);
  if (result == VK_SUCCESS &&
      (format.format == VK_FORMAT_UNDEFINED || (can.supportedUsageFlags & kUsage) != kUsage))
    return Failure("The display takes no images of eight bits a channel that can be read back.");
  if (result == VK_SUCCESS) {
    size_ = choose_size(can, window_size_);
    format_ = format.format;
    // Every device supports the present mode FIFO. It has no tearing, and draws no more frames than
    // the display shows.
    const VkSwapchainKHR old = swapchain_;
    const VkSwapchainCreateInfoKHR info{
        .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
        .surface = surface_,
        .minImageCount = choose_count(can),
        .imageFormat = format.format,
        .imageColorSpace = format.colorSpace,
        .imageExtent = size_,
        .imageArrayLayers = 1,
        .imageUsage = kUsage,
        .preTransform = can.currentTransform,
        .compositeAlpha = (can.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) != 0
                              ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                              : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR,
        .presentMode = VK_PRESENT_MODE_FIFO_KHR,
        .clipped = VK_FALSE,  // what another window covers is read back too
        .oldSwapchain = old};
    swapchain_ = VK_NULL_HANDLE;
    result = vkCreateSwapchainKHR(device.device(), &info, nullptr, &swapchain_);
    vkDestroySwapchainKHR(device.device(), old, nullptr);
  }
  return check(result == VK_SUCCESS ? create_images() : result, "give the window images");
}

VkResult Presenter::create_images() {
  const VkDevice device = gpu_.device().device();
  std::uint32_t count = 0;
  vkGetSwapchainImagesKHR(device, swapchain_, &count, nullptr);
  images_.resize(count);
  VkResult result = vkGetSwapchainImagesKHR(device, swapchain_, &count, images_.data());
  const VkSemaphoreCreateInfo semaphore{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
  for (std::size_t i = 0; result == VK_SUCCESS && i < images_.size(); ++i) {
    const VkImageViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                     .image = images_[i],
                                     .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                     .format = format_,
                                     .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    result = vkCreateImageView(device, &info, nullptr, &views_.emplace_back());
    if (result == VK_SUCCESS)
      result = vkCreateSemaphore(device, &semaphore, nullptr, &drawn_.emplace_back());
  }
  for (std::uint32_t i = 0; result == VK_SUCCESS && i < gpu_.frames_in_flight(); ++i)
    result = vkCreateSemaphore(device, &semaphore, nullptr, &arrived_.emplace_back());
  return result;
}

void Presenter::destroy_images() {
  const VkDevice device = gpu_.device().device();
  for (std::vector<VkSemaphore>* semaphores : {&arrived_, &drawn_}) {
    for (const VkSemaphore semaphore : *semaphores) vkDestroySemaphore(device, semaphore, nullptr);
    semaphores->clear();
  }
  for (const VkImageView view : views_) vkDestroyImageView(device, view, nullptr);
  views_.clear();
}

Presenter::~Presenter() {
  wait();
  destroy_images();
  vkDestroySwapchainKHR(gpu_.device().device(), swapchain_, nullptr);
  vkDestroySurfaceKHR(gpu_.device().instance(), surface_, nullptr);
}

void Presenter::wait() const { vkDeviceWaitIdle(gpu_.device().device()); }

Result<bool> Presenter::prepare() {
  const VkExtent2D size = window_.size();
  if (size.width == 0 || size.height == 0) return false;
  if (outdated_ || size.width != window_size_.width || size.height != window_size_.height)
    ALCOVE_TRY_VOID(create_swapchain());
  if (acquired_) return true;
  ALCOVE_TRY_VOID(gpu_.wait(slot_));
  timings_.clear();
  for (const framegraph::PassTiming& timing : gpu_.timings(slot_))
    timings_.push_back(
        {std::string(timing.name), timing.milliseconds, view_passes_[slot_].contains(timing.pass)});
  const VkResult result = vkAcquireNextImageKHR(gpu_.device().device(), swapchain_, UINT64_MAX,
                                                arrived_[slot_], VK_NULL_HANDLE, &current_);
  acquired_ = result == VK_SUCCESS || result == VK_SUBOPTIMAL_KHR;
  outdated_ = result == VK_SUBOPTIMAL_KHR || result == VK_ERROR_OUT_OF_DATE_KHR;
  if (!acquired_ && !outdated_) return device_failure("get an image of the window", result);
  return acquired_;
}

Result<framegraph::FrameReport> Presenter::draw(const Declare& declare) {
  framegraph::ImportedTexture import;
  import.image = images_[current_];
  import.view = views_[current_];
  import.desc = {format_, framegraph::Extent::absolute(size_.width, size_.height)};
  import.usage = kUsage;
  import.initial_state = {kArrivalStage, 0, VK_IMAGE_LAYOUT_UNDEFINED};
  import.final_state = framegraph::access::present;
  const framegraph::QueueSemaphore arrived{.semaphore = arrived_[slot_], .stages = kArrivalStage};
  const framegraph::QueueSemaphore drawn{.semaphore = drawn_[current_]};
  auto report = gpu_.submit(
      [&](Graph& graph) -> Result<void> {
        ALCOVE_TRY(view_passes_[slot_], declare(graph, graph.import_texture("window", import)));
        return {};
      },
      {.slot = slot_, .waits = {&arrived, 1}, .signals = {&drawn, 1}});
  if (!report) return report;
  slot_ = (slot_ + 1) % gpu_.frames_in_flight();
  acquired_ = false;
  const VkPresentInfoKHR info{.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                              .waitSemaphoreCount = 1,
                              .pWaitSemaphores = &drawn_[current_],
                              .swapchainCount = 1,
                              .pSwapchains = &swapchain_,
                              .pImageIndices = &current_};
  const VkResult result = vkQueuePresentKHR(gpu_.device().queue(), &info);
  outdated_ = outdated_ || result == VK_SUBOPTIMAL_KHR || result == VK_ERROR_OUT_OF_DATE_KHR;
  if (!outdated_ && result != VK_SUCCESS) return device_failure("present a frame", result);
  return report;
}

}  // namespace alcove::sample
