#include "vulkan/host_buffer.h"

#include "alcove/framegraph/device_memory.h"
#include "vulkan/vulkan_error.h"

namespace alcove::passes {

tl::expected<std::unique_ptr<HostBuffer>, Error> HostBuffer::create(
    const framegraph::VulkanFunctions& vk, const framegraph::DeviceHandles& device,
    std::string_view name, VkDeviceSize size, VkBufferUsageFlags usage) {
  std::unique_ptr<HostBuffer> host_buffer(new HostBuffer(vk, device));
  const VkBufferCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size, .usage = usage};
  VkResult result = vk.vkCreateBuffer(device.device, &info, device.host.allocation_callbacks,
                                      &host_buffer->buffer_);
  if (result == VK_SUCCESS) result = host_buffer->allocate();
  if (result != VK_SUCCESS) return creation_error(name, result);
  return host_buffer;
}

VkResult HostBuffer::allocate() {
  VkMemoryRequirements needs;
  vk_.vkGetBufferMemoryRequirements(device_.device, buffer_, &needs);
  // Vulkan guarantees that every buffer can lie in memory with these properties.
  constexpr VkMemoryPropertyFlags kProperties =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  const VkResult result = framegraph::allocate_memory(vk_, device_, {needs, kProperties}, memory_);
  if (result != VK_SUCCESS) return result;
  return vk_.vkBindBufferMemory(device_.device, buffer_, memory_.memory, memory_.offset);
}

HostBuffer::~HostBuffer() {
  vk_.vkDestroyBuffer(device_.device, buffer_, device_.host.allocation_callbacks);
  framegraph::free_memory(vk_, device_, memory_);
}

}  // namespace alcove::passes
