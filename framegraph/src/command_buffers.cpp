#include "command_buffers.h"

namespace alcove::framegraph {

void CommandBuffers::destroy(const DeviceContext& device) {
  device.vk.vkDestroyCommandPool(device.handles.device, pool_, device.callbacks());
}

VkResult CommandBuffers::next(const DeviceContext& device, QueueClass queue,
                              VkCommandBuffer& commands) {
  if (pool_ == VK_NULL_HANDLE) {
    const VkCommandPoolCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .queueFamilyIndex = device.limits.queue_families[static_cast<std::size_t>(queue)]};
    const VkResult result =
        device.vk.vkCreateCommandPool(device.handles.device, &info, device.callbacks(), &pool_);
    if (result != VK_SUCCESS) return result;
  }
  if (used_ == buffers_.size()) {
    const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                           .commandPool = pool_,
                                           .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                           .commandBufferCount = 1};
    VkCommandBuffer buffer = VK_NULL_HANDLE;
    const VkResult result =
        device.vk.vkAllocateCommandBuffers(device.handles.device, &info, &buffer);
    if (result != VK_SUCCESS) return result;
    buffers_.push_back(buffer);
  }
  commands = buffers_[used_++];
  return VK_SUCCESS;
}

VkResult CommandBuffers::take_back(const DeviceContext& device) {
  if (used_ == 0) return VK_SUCCESS;
  const VkResult result = device.vk.vkResetCommandPool(device.handles.device, pool_, 0);
  if (result == VK_SUCCESS) used_ = 0;
  return result;
}

}  // namespace alcove::framegraph
