// Device memory from the caller's MemoryFunctions, or from Vulkan if the caller gives none.
#pragma once

#include "alcove/framegraph/executor.h"

namespace alcove::framegraph {

// Allocates device memory. Vulkan's memory is of the first type that has the required and the
// preferred properties, or of the first that has the required ones if no type has both. If they
// include VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT, the range is mapped. Errors leave `range` empty:
// that of the allocation, VK_ERROR_OUT_OF_DEVICE_MEMORY if no memory type suits, or
// VK_ERROR_MEMORY_MAP_FAILED if the caller's function has not mapped what must be visible.
[[nodiscard]] VkResult allocate_memory(const VulkanFunctions& vk, const DeviceHandles& device,
                                       const MemoryRequest& request, MemoryRange& range);
// Frees a range that allocate_memory() filled. A range without memory is ignored.
void free_memory(const VulkanFunctions& vk, const DeviceHandles& device, const MemoryRange& range);

}  // namespace alcove::framegraph
