// Command buffers of one pool, handed out one after the other and taken back together.
#pragma once

#include <cstddef>
#include <vector>

#include "device_context.h"

namespace alcove::framegraph {

// Command buffers of one device, queue class, frame slot and thread, made on first use and kept.
class CommandBuffers {
 public:
  void destroy(const DeviceContext& device);
  // The next one, not yet begun.
  [[nodiscard]] VkResult next(const DeviceContext& device, QueueClass queue,
                              VkCommandBufferLevel level, VkCommandBuffer& commands);
  // Takes back all that were handed out: the device has finished with them.
  [[nodiscard]] VkResult take_back(const DeviceContext& device);

 private:
  VkCommandPool pool_ = VK_NULL_HANDLE;
  std::vector<VkCommandBuffer> made_;
  std::size_t used_ = 0;
};

}  // namespace alcove::framegraph
