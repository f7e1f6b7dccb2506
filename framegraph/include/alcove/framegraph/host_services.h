// Services that the caller may provide in place of Vulkan's defaults: host memory for the driver,
// device memory, and a log. Everything here is optional, and must outlive the executor and the
// kernels that it is given to.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>

namespace alcove::framegraph {

// Device memory that is needed.
struct MemoryRequest {
  VkMemoryRequirements requirements{};  // size, alignment, and the memory types that will do
  VkMemoryPropertyFlags required = 0;   // properties that the memory type must have
  VkMemoryPropertyFlags preferred = 0;  // properties that it should have
  // A buffer with a device address will be bound: allocate with
  // VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT.
  bool device_address = false;
};

// A part of a device memory object, whose first byte is `offset`, a multiple of the alignment.
struct MemoryRange {
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkDeviceSize offset = 0;
  // The address of the first byte in host memory. Needed if VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT was
  // required: the memory then stays mapped until it is freed.
  void* mapped = nullptr;
  // For `free`: anything that finds the allocation again.
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

// Memory that the caller has allocated, for the transients and histories of one executor. If it is
// full, or a resource cannot lie in its memory type, MemoryFunctions provide the rest. If there are
// no functions, a full block is an error (VK_ERROR_OUT_OF_DEVICE_MEMORY), and a resource that
// cannot lie in the memory type is allocated with vkAllocateMemory.
struct MemoryBlock {
  VkDeviceMemory memory = VK_NULL_HANDLE;  // null: there is no block
  VkDeviceSize offset = 0;                 // the first byte that may be used
  VkDeviceSize size = 0;                   // bytes from there on
  std::uint32_t memory_type = 0;           // index of the type that the block was allocated from
};

enum class Severity : std::uint8_t { info, warning, error };

// Receives one sentence at a time, terminated by zero and valid during the call. It must not call
// the library.
struct Log {
  void (*write)(void* user, Severity severity, const char* sentence) = nullptr;
  void* user = nullptr;
};

struct HostServices {
  // Given to every function of Vulkan that creates or destroys something.
  const VkAllocationCallbacks* allocation_callbacks = nullptr;
  MemoryFunctions memory;
  MemoryBlock block;
  Log log;
};

}  // namespace alcove::framegraph
