#include "vulkan/host_buffer.h"

namespace alcove::passes {
namespace {

constexpr VkMemoryPropertyFlags kProperties =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;

// Returns the first memory type in the mask `bits` that is host-visible and host-coherent. Vulkan
// guarantees that such a type exists for every buffer.
std::uint32_t coherent_type(const VkPhysicalDeviceMemoryProperties& memory, std::uint32_t bits) {
  std::uint32_t type = 0;
  while (type < memory.memoryTypeCount &&
         ((bits >> type & 1u) == 0 ||
          (memory.memoryTypes[type].propertyFlags & kProperties) != kProperties))
    ++type;
  return type;
}

}  // namespace

tl::expected<std::unique_ptr<HostBuffer>, VkResult> HostBuffer::create(
    const framegraph::VulkanFunctions& vk, const framegraph::DeviceHandles& device,
    VkDeviceSize size, VkBufferUsageFlags usage) {
  std::unique_ptr<HostBuffer> host_buffer(new HostBuffer(vk, device));
  const VkBufferCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size, .usage = usage};
  VkResult result = vk.vkCreateBuffer(device.device, &info, device.host.allocation_callbacks,
                                      &host_buffer->buffer_);
  if (result == VK_SUCCESS) result = host_buffer->allocate();
  if (result != VK_SUCCESS) return tl::unexpected(result);
  return host_buffer;
}

VkResult HostBuffer::allocate() {
  VkMemoryRequirements needs;
  vk_.vkGetBufferMemoryRequirements(device_.device, buffer_, &needs);
  VkResult result = device_.host.memory.allocate != nullptr ? allocate_from_caller(needs)
                                                            : allocate_from_vulkan(needs);
  if (result == VK_SUCCESS)
    result = vk_.vkBindBufferMemory(device_.device, buffer_, memory_.memory, memory_.offset);
  bytes_ = static_cast<std::byte*>(memory_.mapped);
  return result;
}

VkResult HostBuffer::allocate_from_caller(const VkMemoryRequirements& needs) {
  const framegraph::MemoryFunctions& memory = device_.host.memory;
  const VkResult result = memory.allocate(memory.user, {needs, kProperties}, memory_);
  if (result != VK_SUCCESS) {
    memory_ = {};
    return result;
  }
  return memory_.mapped == nullptr ? VK_ERROR_MEMORY_MAP_FAILED : VK_SUCCESS;
}

VkResult HostBuffer::allocate_from_vulkan(const VkMemoryRequirements& needs) {
  VkPhysicalDeviceMemoryProperties memory;
  vk_.vkGetPhysicalDeviceMemoryProperties(device_.physical_device, &memory);
  const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                  .allocationSize = needs.size,
                                  .memoryTypeIndex = coherent_type(memory, needs.memoryTypeBits)};
  const VkResult result = vk_.vkAllocateMemory(device_.device, &info,
                                               device_.host.allocation_callbacks, &memory_.memory);
  return result == VK_SUCCESS
             ? vk_.vkMapMemory(device_.device, memory_.memory, 0, VK_WHOLE_SIZE, 0, &memory_.mapped)
             : result;
}

HostBuffer::~HostBuffer() {
  const framegraph::HostServices& host = device_.host;
  vk_.vkDestroyBuffer(device_.device, buffer_, host.allocation_callbacks);
  if (memory_.memory == VK_NULL_HANDLE) return;
  if (host.memory.free != nullptr)
    host.memory.free(host.memory.user, memory_);
  else
    vk_.vkFreeMemory(device_.device, memory_.memory, host.allocation_callbacks);
}

}  // namespace alcove::passes
