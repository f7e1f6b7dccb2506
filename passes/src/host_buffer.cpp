#include "host_buffer.h"

namespace alcove::passes {
namespace {

// The first memory type of these bits that the host sees without flushes. Vulkan promises one to
// every buffer.
std::uint32_t coherent_type(const VkPhysicalDeviceMemoryProperties& memory, std::uint32_t bits) {
  constexpr VkMemoryPropertyFlags kWanted =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  std::uint32_t type = 0;
  while (
      type < memory.memoryTypeCount &&
      ((bits >> type & 1u) == 0 || (memory.memoryTypes[type].propertyFlags & kWanted) != kWanted)) {
    ++type;
  }
  return type;
}

}  // namespace

tl::expected<std::unique_ptr<HostBuffer>, VkResult> HostBuffer::create(
    const framegraph::VulkanFunctions& vk, VkPhysicalDevice physical_device, VkDevice device,
    VkDeviceSize size, VkBufferUsageFlags usage) {
  std::unique_ptr<HostBuffer> made(new HostBuffer(vk, device));
  const VkBufferCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size, .usage = usage};
  VkResult result = vk.vkCreateBuffer(device, &info, nullptr, &made->buffer_);
  if (result == VK_SUCCESS) {
    result = made->allocate(physical_device);
  }
  if (result != VK_SUCCESS) {
    return tl::unexpected(result);
  }
  return made;
}

VkResult HostBuffer::allocate(VkPhysicalDevice physical_device) {
  VkMemoryRequirements needs;
  vk_.vkGetBufferMemoryRequirements(device_, buffer_, &needs);
  VkPhysicalDeviceMemoryProperties memory;
  vk_.vkGetPhysicalDeviceMemoryProperties(physical_device, &memory);
  const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                  .allocationSize = needs.size,
                                  .memoryTypeIndex = coherent_type(memory, needs.memoryTypeBits)};
  VkResult result = vk_.vkAllocateMemory(device_, &info, nullptr, &memory_);
  if (result == VK_SUCCESS) {
    result = vk_.vkBindBufferMemory(device_, buffer_, memory_, 0);
  }
  void* pointer = nullptr;
  if (result == VK_SUCCESS) {
    result = vk_.vkMapMemory(device_, memory_, 0, VK_WHOLE_SIZE, 0, &pointer);
  }
  bytes_ = static_cast<std::byte*>(pointer);
  return result;
}

HostBuffer::~HostBuffer() {
  vk_.vkDestroyBuffer(device_, buffer_, nullptr);
  vk_.vkFreeMemory(device_, memory_, nullptr);
}

}  // namespace alcove::passes
