// Device memory for transients and histories: from the caller's block, from the caller's functions,
// or from vkAllocateMemory.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "device_context.h"

namespace alcove::framegraph {

class DeviceAllocator {
 public:
  explicit DeviceAllocator(const DeviceContext& device) : device_(device) {}
  DeviceAllocator(const DeviceAllocator&) = delete;
  DeviceAllocator& operator=(const DeviceAllocator&) = delete;

  [[nodiscard]] VkResult allocate(const MemoryRequest& request, MemoryRange& range);
  // Frees the range. A range without memory is ignored.
  void free(const MemoryRange& range);

  // Returns the reason why an allocation has failed since the last call, as a clause that begins
  // with "because". The text is empty if Vulkan's result says everything.
  std::string take_reason() { return std::exchange(reason_, {}); }

 private:
  struct BlockRange {
    VkDeviceSize begin = 0;
    VkDeviceSize end = 0;
  };

  bool suits_block(const MemoryRequest& request) const;
  bool allocate_in_block(const MemoryRequest& request, MemoryRange& range);
  VkResult allocate_from_vulkan(const MemoryRequest& request, MemoryRange& range);

  const DeviceContext& device_;
  std::vector<BlockRange> used_;  // ranges of the block in use, ascending
  std::string reason_;
};

}  // namespace alcove::framegraph
