#include "gpu/gpu_image.h"

namespace alcove::sample {

VkImageAspectFlags aspect_of(VkFormat format) {
  return format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

tl::expected<std::unique_ptr<GpuImage>, std::string> GpuImage::create(const VulkanDevice& owner,
                                                                      VkFormat format,
                                                                      VkExtent2D size,
                                                                      VkImageUsageFlags usage,
                                                                      std::uint32_t mips) {
  std::unique_ptr<GpuImage> made(new GpuImage(owner));
  made->format_ = format;
  made->size_ = size;
  made->mips_ = mips;
  made->usage_ = usage;
  const VkDevice device = owner.device();
  const VkImageCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                               .imageType = VK_IMAGE_TYPE_2D,
                               .format = format,
                               .extent = {size.width, size.height, 1},
                               .mipLevels = mips,
                               .arrayLayers = 1,
                               .samples = VK_SAMPLE_COUNT_1_BIT,
                               .usage = usage};
  VkResult result = vkCreateImage(device, &info, nullptr, &made->image_);
  if (result == VK_SUCCESS) {
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device, made->image_, &needs);
    if (needs.size > owner.max_allocation()) {
      return too_large("an image of " + std::to_string(size.width) + "x" +
                           std::to_string(size.height) + " pixels",
                       needs.size, owner);
    }
    const VkMemoryAllocateInfo allocation{
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
        .allocationSize = needs.size,
        .memoryTypeIndex =
            owner.memory_type(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)};
    result = vkAllocateMemory(device, &allocation, nullptr, &made->memory_);
  }
  if (result == VK_SUCCESS) {
    result = vkBindImageMemory(device, made->image_, made->memory_, 0);
  }
  if (result == VK_SUCCESS) {
    const VkImageViewCreateInfo view{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                     .image = made->image_,
                                     .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                     .format = format,
                                     .subresourceRange = {aspect_of(format), 0, mips, 0, 1}};
    result = vkCreateImageView(device, &view, nullptr, &made->view_);
  }
  if (result != VK_SUCCESS) {
    return device_failure("give an image of " + std::to_string(size.width) + "x" +
                              std::to_string(size.height) + " pixels",
                          result);
  }
  return made;
}

GpuImage::~GpuImage() {
  vkDestroyImageView(device_.device(), view_, nullptr);
  vkDestroyImage(device_.device(), image_, nullptr);
  vkFreeMemory(device_.device(), memory_, nullptr);
}

framegraph::ImportedTexture GpuImage::import() const {
  framegraph::ImportedTexture import;
  import.image = image_;
  import.view = view_;
  import.desc = {format_, framegraph::Extent::absolute(size_.width, size_.height), mips_};
  import.usage = usage_;
  return import;
}

framegraph::ImportedTexture GpuImage::import_to_fill(framegraph::State final_state) const {
  framegraph::ImportedTexture result = import();
  result.final_state = final_state;
  return result;
}

framegraph::ImportedTexture GpuImage::import_to_read(framegraph::State initial_state) const {
  framegraph::ImportedTexture result = import();
  result.initial_state = initial_state;
  result.final_state = initial_state;
  return result;
}

}  // namespace alcove::sample
