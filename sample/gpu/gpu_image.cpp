#include "gpu/gpu_image.h"

namespace alcove::sample {

VkImageAspectFlags aspect_of(VkFormat format) {
  switch (format) {
    case VK_FORMAT_D16_UNORM:
    case VK_FORMAT_X8_D24_UNORM_PACK32:
    case VK_FORMAT_D32_SFLOAT:
    case VK_FORMAT_D16_UNORM_S8_UINT:
    case VK_FORMAT_D24_UNORM_S8_UINT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
      return VK_IMAGE_ASPECT_DEPTH_BIT;
    default:
      return VK_IMAGE_ASPECT_COLOR_BIT;
  }
}

tl::expected<std::unique_ptr<GpuImage>, std::string> GpuImage::create(
    const VulkanDevice& owner, const framegraph::TextureDesc& desc, VkImageUsageFlags usage) {
  constexpr VkImageUsageFlags kUsedByViews =
      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
      VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  std::unique_ptr<GpuImage> made(new GpuImage(owner));
  made->desc_ = desc;
  made->usage_ = usage;
  const VkDevice device = owner.device();
  const std::string name = "an image of " + std::to_string(desc.extent.width) + "x" +
                           std::to_string(desc.extent.height) + " pixels";
  const VkImageCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                               .flags = desc.flags,
                               .imageType = VK_IMAGE_TYPE_2D,
                               .format = desc.format,
                               .extent = {desc.extent.width, desc.extent.height, 1},
                               .mipLevels = desc.mips,
                               .arrayLayers = desc.layers,
                               .samples = desc.samples,
                               .usage = usage};
  VkResult result = vkCreateImage(device, &info, nullptr, &made->image_);
  if (result == VK_SUCCESS) {
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device, made->image_, &needs);
    if (needs.size > owner.max_allocation()) return too_large(name, needs.size, owner);
    result = owner.allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, made->memory_);
  }
  if (result == VK_SUCCESS) result = vkBindImageMemory(device, made->image_, made->memory_, 0);
  if (result == VK_SUCCESS && (usage & kUsedByViews) != 0) {
    const VkImageViewCreateInfo view{
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = made->image_,
        .viewType = desc.layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D,
        .format = desc.format,
        .subresourceRange = {aspect_of(desc.format), 0, desc.mips, 0, desc.layers}};
    result = vkCreateImageView(device, &view, nullptr, &made->view_);
  }
  if (result != VK_SUCCESS) return device_failure("give " + name, result);
  return made;
}

GpuImage::~GpuImage() {
  vkDestroyImageView(device_.device(), view_, nullptr);
  vkDestroyImage(device_.device(), image_, nullptr);
  vkFreeMemory(device_.device(), memory_, nullptr);
}

framegraph::ImportedTexture GpuImage::import() const {
  return {.image = image_, .view = view_, .desc = desc_, .usage = usage_};
}

framegraph::ImportedTexture GpuImage::import_to_fill(framegraph::State final_state) const {
  framegraph::ImportedTexture result = import();
  result.initial_state = {final_state.stages, 0, VK_IMAGE_LAYOUT_UNDEFINED};
  result.final_state = final_state;
  return result;
}

framegraph::ImportedTexture GpuImage::import_to_read(framegraph::State initial_state) const {
  framegraph::ImportedTexture result = import();
  result.initial_state = result.final_state = initial_state;
  return result;
}

}  // namespace alcove::sample
