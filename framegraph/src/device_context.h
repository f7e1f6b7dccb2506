// The caller's device, its functions, properties and limits, shared by the parts of the executor.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "alcove/framegraph/error.h"
#include "alcove/framegraph/executor.h"
#include "alcove/framegraph/vulkan_functions.h"

namespace alcove::framegraph {

struct DeviceContext {
  DeviceHandles handles;
  VulkanFunctions vk;
  VkPhysicalDeviceProperties properties{};
  // The number of valid bits of a timestamp for each queue class, or 0 if the queue has no
  // timestamps.
  std::uint32_t timestamp_bits[kQueueClasses] = {};
  Limits limits;
  bool is_validated = false;            // by validation layers
  std::vector<std::uint32_t> families;  // of the queues, each once

  const VkAllocationCallbacks* callbacks() const { return handles.host.allocation_callbacks; }
};

// A name for the debuggers of Vulkan, cut to 63 bytes.
struct DebugName {
  explicit DebugName(std::string_view name) { name.copy(text, sizeof text - 1); }
  char text[64] = {};
};

// Fetches the functions, properties and limits of a device. The error names the function or feature
// that the device lacks.
[[nodiscard]] tl::expected<void, Errors> open(DeviceContext& context, const DeviceHandles& handles);

// Creates the image or buffer of a resource, without memory, and queries its memory requirements.
[[nodiscard]] VkResult create_unbound(const DeviceContext& device, const ResourceRecord& record,
                                      VkFlags usage, bool concurrent, VkImage& image,
                                      VkBuffer& buffer, VkMemoryRequirements& requirements);

Errors vulkan_error(VkResult result, std::string what);
// Returns the name of a result, for example `VK_ERROR_OUT_OF_DEVICE_MEMORY`.
const char* result_name(VkResult result);

}  // namespace alcove::framegraph
