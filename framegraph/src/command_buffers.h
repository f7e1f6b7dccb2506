// A pool of command buffers that are handed out one after the other and taken back together.
#pragma once

#include <cstddef>
#include <vector>

#include "device_context.h"

namespace alcove::framegraph {

// The command buffers for one queue class and frame slot. They are allocated on
// first use and reused in later frames.
class CommandBuffers {
 public:
  void destroy(const DeviceContext& device);
  // Returns the next command buffer, which is not yet in the recording state.
  [[nodiscard]] VkResult next(const DeviceContext& device, QueueClass queue,
                              VkCommandBuffer& commands);
  // Takes back all command buffers that were handed out. The device must have finished them.
  [[nodiscard]] VkResult take_back(const DeviceContext& device);

 private:
  VkCommandPool pool_ = VK_NULL_HANDLE;
  std::vector<VkCommandBuffer> buffers_;
  std::size_t used_ = 0;
};

}  // namespace alcove::framegraph
