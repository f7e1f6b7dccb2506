// Services that the caller may provide instead of Vulkan's defaults: host memory for the driver,
// device memory, and a log. All of them are optional. The functions and memory that the caller
// provides must outlive the executor and the pipelines that use them.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>

namespace alcove::framegraph {

// When the contents of memory are needed.
enum class MemoryLifetime : std::uint8_t {
  persistent,  // until it is freed
  // From the first to the last command that a frame records, as for transients. Between frames the
  // caller may use the memory for something else, ordered by barriers of its own.
  frame,
};

// A request for device memory.
struct MemoryRequest {
  VkMemoryRequirements requirements{};  // size, alignment, and the allowed memory types
  VkMemoryPropertyFlags required = 0;   // properties that the memory type must have
  VkMemoryPropertyFlags preferred = 0;  // properties that the memory type should have
  // Whether a buffer with a device address will be bound to the memory. If so, the memory must be
  // allocated with VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT.
  bool device_address = false;
  MemoryLifetime lifetime = MemoryLifetime::persistent;
};

// A range of a device memory object. It begins at `offset` bytes, a multiple of the alignment.
struct MemoryRange {
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkDeviceSize offset = 0;
  // The address of the range in host memory. It is needed if VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT
  // was required: the memory must then stay mapped until it is freed.
  void* mapped = nullptr;
  // A value of the caller's, which `free` gets back to find the allocation.
  void* handle = nullptr;
};

// The caller's allocator of device memory. Give both functions or neither. Without them the library
// calls vkAllocateMemory and vkFreeMemory. The functions are called on the thread that creates,
// records or destroys. `free` is called only after the device has finished with the memory.
struct MemoryFunctions {
  // Fills `range`, which is all zeros when the function is called. Any result but VK_SUCCESS makes
  // the call of the library fail, with that result in its error.
  VkResult (*allocate)(void* user, const MemoryRequest& request, MemoryRange& range) = nullptr;
  void (*free)(void* user, const MemoryRange& range) = nullptr;
  void* user = nullptr;
};

enum class Severity : std::uint8_t { info, warning, error };

// The caller's log. `write` receives one sentence at a time, terminated by zero and valid during
// the call. It must not call the library.
struct Log {
  void (*write)(void* user, Severity severity, const char* sentence) = nullptr;
  void* user = nullptr;
};

struct HostServices {
  // Given to every Vulkan function that creates or destroys an object.
  const VkAllocationCallbacks* allocation_callbacks = nullptr;
  MemoryFunctions memory;
  Log log;
};

}  // namespace alcove::framegraph
