// The caller's device as the executor's parts see it.
#pragma once

#include <string>

#include "alcove/framegraph/error.h"
#include "alcove/framegraph/executor.h"
#include "alcove/framegraph/vulkan_functions.h"

namespace alcove::framegraph {

struct DeviceContext {
  DeviceHandles handles;
  VulkanFunctions vk;
  VkPhysicalDeviceProperties properties{};
  VkPhysicalDeviceMemoryProperties memory{};
  // By queue class: the bits of a timestamp that count, 0 where the queue has no timestamps.
  std::uint32_t timestamp_bits[kQueueClasses] = {};
  Limits limits;

  const VkAllocationCallbacks* callbacks() const { return handles.host.allocation_callbacks; }
};

// Functions, properties and limits of a device; the error says what it lacks.
[[nodiscard]] tl::expected<void, Errors> open(DeviceContext& context, const DeviceHandles& handles);

// The create infos that memory requirements are asked for, and resources created with.
VkImageCreateInfo image_info(const ResourceRecord& record, VkFlags usage);
VkBufferCreateInfo buffer_info(const ResourceRecord& record, VkFlags usage);

Errors vulkan_error(VkResult result, std::string what);
// `VK_ERROR_OUT_OF_DEVICE_MEMORY` and so on.
const char* result_name(VkResult result);

}  // namespace alcove::framegraph
