// Device memory for transients and histories: from the caller's functions, or from
// vkAllocateMemory.
#pragma once

#include "device_context.h"

namespace alcove::framegraph {

[[nodiscard]] VkResult allocate(const DeviceContext& device, const MemoryRequest& request,
                                MemoryRange& range);
// Frees the range. A range without memory is ignored.
void free(const DeviceContext& device, const MemoryRange& range);

}  // namespace alcove::framegraph
