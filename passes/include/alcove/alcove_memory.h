// Device memory: the allocator that the engine gives to a context, and the amounts that frames
// take. Included by alcove.h.
#ifndef ALCOVE_ALCOVE_MEMORY_H_
#define ALCOVE_ALCOVE_MEMORY_H_

#include <vulkan/vulkan_core.h>

#include "alcove/alcove_result.h"

#ifdef __cplusplus
extern "C" {
#endif

// When the contents of device memory are needed.
typedef enum AlcoveMemoryLifetime {
  ALCOVE_MEMORY_LIFETIME_PERSISTENT = 0,  // until it is freed: histories and parameters
  // From the first to the last command that alcoveRecordFrame records: intermediate images. The
  // engine may use the memory for something else before and after, if its barriers order that use
  // with these commands (VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, shader reads and writes).
  ALCOVE_MEMORY_LIFETIME_FRAME = 1,
  ALCOVE_MEMORY_LIFETIME_MAX_ENUM = 0x7fffffff
} AlcoveMemoryLifetime;

// Device memory that a context needs.
typedef struct AlcoveMemoryRequest {
  VkMemoryRequirements requirements;  // size, alignment, and the memory types that will do
  VkMemoryPropertyFlags required;     // properties that the memory type must have
  VkMemoryPropertyFlags preferred;    // properties that it should have
  AlcoveMemoryLifetime lifetime;
} AlcoveMemoryRequest;

// A part of a device memory object.
typedef struct AlcoveMemoryRange {
  VkDeviceMemory memory;
  VkDeviceSize offset;  // of the first byte, a multiple of the alignment
  // The address of the first byte in host memory. Needed if VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT was
  // required: the memory then stays mapped until it is freed.
  void* mapped;
  void* handle;  // the engine's own, for `free`
} AlcoveMemoryRange;

// The engine's allocator of device memory. Give both functions or neither. They are called on the
// thread that calls the library, and must not call the library. `free` is called only after the
// device has finished with the memory.
typedef struct AlcoveMemoryFunctions {
  // Fills `range`, which is all zeros when the function is called. Any result but VK_SUCCESS makes
  // the Alcove call fail; VK_ERROR_OUT_OF_DEVICE_MEMORY becomes ALCOVE_ERROR_OUT_OF_DEVICE_MEMORY.
  VkResult (*allocate)(void* user, const AlcoveMemoryRequest* request, AlcoveMemoryRange* range);
  void (*free)(void* user, const AlcoveMemoryRange* range);
  void* user;
} AlcoveMemoryFunctions;

// The bytes of device memory of the last recorded frame. All are zero before the first frame, and
// after a frame that failed or was discarded. `transients` is the memory that this frame uses. The
// context holds as much as the largest frame so far has used, which `allocated` counts.
typedef struct AlcoveMemory {
  uint32_t struct_size;
  uint64_t transients;           // intermediate images, which share memory
  uint64_t transients_unshared;  // the same if each had memory of its own
  uint64_t history;              // of all views
  uint64_t allocated;            // everything that the context holds, with parameters and tables
} AlcoveMemory;

// Fills `memory`, whose struct_size must be set.
AlcoveResult alcoveGetMemory(AlcoveContext* context, AlcoveMemory* memory);

#ifdef __cplusplus
}
#endif

#endif  // ALCOVE_ALCOVE_MEMORY_H_
