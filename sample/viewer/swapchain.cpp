#include "viewer/swapchain.h"

#include <algorithm>

#include "alcove/framegraph/access.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

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
  if (can.currentExtent.width != UINT32_MAX) {
    return can.currentExtent;
  }
  return {std::clamp(wanted.width, can.minImageExtent.width, can.maxImageExtent.width),
          std::clamp(wanted.height, can.minImageExtent.height, can.maxImageExtent.height)};
}

// Returns one more than the least number of images, so that one can be drawn while another waits to
// be shown.
std::uint32_t choose_count(const VkSurfaceCapabilitiesKHR& can) {
  const std::uint32_t most = can.maxImageCount == 0 ? UINT32_MAX : can.maxImageCount;
  return std::min(can.minImageCount + 1, most);
}

Failure failure(VkResult result) { return device_failure("give the window images", result); }

}  // namespace

tl::expected<std::unique_ptr<Swapchain>, std::string> Swapchain::create(
    const VulkanDevice& device, VkSurfaceKHR surface, VkExtent2D size,
    std::uint32_t frames_in_flight, std::unique_ptr<Swapchain> old) {
  VkBool32 supported = VK_FALSE;
  vkGetPhysicalDeviceSurfaceSupportKHR(device.physical_device(), device.queue_family(), surface,
                                       &supported);
  if (supported == VK_FALSE) {
    return Failure(std::string(device.properties().deviceName) +
                   " cannot present to this display; `alcove render` needs none.");
  }
  VkSurfaceCapabilitiesKHR can{};
  VkResult result =
      vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device.physical_device(), surface, &can);
  if (result != VK_SUCCESS) {
    return failure(result);
  }
  const VkSurfaceFormatKHR format = choose_format(device.physical_device(), surface);
  if (format.format == VK_FORMAT_UNDEFINED || (can.supportedUsageFlags & kUsage) != kUsage) {
    return Failure("The display takes no images of eight bits a channel that can be read back.");
  }
  std::unique_ptr<Swapchain> made(new Swapchain(device));
  made->size_ = choose_size(can, size);
  made->format_ = format.format;
  // Every device supports the present mode FIFO. It has no tearing, and draws no more frames than
  // the display shows.
  const VkSwapchainCreateInfoKHR info{
      .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
      .surface = surface,
      .minImageCount = choose_count(can),
      .imageFormat = format.format,
      .imageColorSpace = format.colorSpace,
      .imageExtent = made->size_,
      .imageArrayLayers = 1,
      .imageUsage = kUsage,
      .preTransform = can.currentTransform,
      .compositeAlpha = (can.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) != 0
                            ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                            : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR,
      .presentMode = VK_PRESENT_MODE_FIFO_KHR,
      .clipped = VK_FALSE,  // what another window covers is read back too
      .oldSwapchain = old ? old->swapchain_ : VK_NULL_HANDLE};
  result = vkCreateSwapchainKHR(device.device(), &info, nullptr, &made->swapchain_);
  if (result == VK_SUCCESS) {
    result = made->create_views();
  }
  if (result == VK_SUCCESS) {
    result = made->create_semaphores(frames_in_flight);
  }
  if (result != VK_SUCCESS) {
    return failure(result);
  }
  return made;
}

VkResult Swapchain::create_views() {
  std::uint32_t count = 0;
  vkGetSwapchainImagesKHR(device_.device(), swapchain_, &count, nullptr);
  images_.resize(count);
  VkResult result = vkGetSwapchainImagesKHR(device_.device(), swapchain_, &count, images_.data());
  for (std::size_t i = 0; result == VK_SUCCESS && i < images_.size(); ++i) {
    const VkImageViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                     .image = images_[i],
                                     .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                     .format = format_,
                                     .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    result = vkCreateImageView(device_.device(), &info, nullptr, &views_.emplace_back());
  }
  return result;
}

VkResult Swapchain::create_semaphores(std::uint32_t frames_in_flight) {
  const VkSemaphoreCreateInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
  VkResult result = VK_SUCCESS;
  for (std::uint32_t i = 0; result == VK_SUCCESS && i < frames_in_flight; ++i) {
    result = vkCreateSemaphore(device_.device(), &info, nullptr, &arrived_.emplace_back());
  }
  for (std::size_t i = 0; result == VK_SUCCESS && i < images_.size(); ++i) {
    result = vkCreateSemaphore(device_.device(), &info, nullptr, &drawn_.emplace_back());
  }
  return result;
}

Swapchain::~Swapchain() {
  const VkDevice device = device_.device();
  for (const VkSemaphore semaphore : arrived_) {
    vkDestroySemaphore(device, semaphore, nullptr);
  }
  for (const VkSemaphore semaphore : drawn_) {
    vkDestroySemaphore(device, semaphore, nullptr);
  }
  for (const VkImageView view : views_) {
    vkDestroyImageView(device, view, nullptr);
  }
  vkDestroySwapchainKHR(device, swapchain_, nullptr);
}

VkResult Swapchain::acquire(std::uint32_t slot) {
  return vkAcquireNextImageKHR(device_.device(), swapchain_, UINT64_MAX, arrived_[slot],
                               VK_NULL_HANDLE, &current_);
}

framegraph::ImportedTexture Swapchain::import() const {
  framegraph::ImportedTexture import;
  import.image = images_[current_];
  import.view = views_[current_];
  import.desc = {format_, framegraph::Extent::absolute(size_.width, size_.height)};
  import.usage = kUsage;
  import.initial_state = {kArrivalStage, 0, VK_IMAGE_LAYOUT_UNDEFINED};
  import.final_state = framegraph::access::present;
  return import;
}

VkResult Swapchain::present() const {
  const VkPresentInfoKHR info{.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                              .waitSemaphoreCount = 1,
                              .pWaitSemaphores = &drawn_[current_],
                              .swapchainCount = 1,
                              .pSwapchains = &swapchain_,
                              .pImageIndices = &current_};
  return vkQueuePresentKHR(device_.queue(), &info);
}

}  // namespace alcove::sample
