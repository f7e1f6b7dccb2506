// Results, limits and the version of Alcove's C interface. Included by alcove.h.
#ifndef ALCOVE_ALCOVE_RESULT_H_
#define ALCOVE_ALCOVE_RESULT_H_

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

// The version of this header, 0.1.0, as VK_MAKE_API_VERSION encodes versions.
#define ALCOVE_VERSION ((0u << 22) | (1u << 12) | 0u)
#define ALCOVE_MAX_VIEWS 8  // the most views in a frame
#define ALCOVE_MAX_FRAMES_IN_FLIGHT 8
#define ALCOVE_MAX_NAME 32      // bytes of a pass's name with its terminating zero
#define ALCOVE_MAX_MESSAGE 512  // bytes of a message with its zero; longer messages are cut

typedef enum AlcoveResult {
  ALCOVE_SUCCESS = 0,
  ALCOVE_ERROR_INVALID_INPUT = -1,  // the caller gave something that cannot be used
  ALCOVE_ERROR_UNSUPPORTED = -2,    // the device lacks something
  ALCOVE_ERROR_OUT_OF_HOST_MEMORY = -3,
  ALCOVE_ERROR_OUT_OF_DEVICE_MEMORY = -4,
  ALCOVE_ERROR_DEVICE_LOST = -5,  // the context can no longer be used: destroy it
  ALCOVE_ERROR_VULKAN = -6,       // another Vulkan error; the message has its VkResult
  ALCOVE_ERROR_INTERNAL = -7,     // an error of the library itself
  ALCOVE_RESULT_MAX_ENUM = 0x7fffffff
} AlcoveResult;

// Returns the name of a result, such as "ALCOVE_SUCCESS". It has static storage and is never null.
const char* alcoveGetResultName(AlcoveResult result);

// ALCOVE_VERSION as it was when the library was compiled.
uint32_t alcoveGetVersion(void);

// The objects that alcoveCreateContext creates: pipelines, histories and memory on one device.
typedef struct AlcoveContext AlcoveContext;

#ifdef __cplusplus
}
#endif

#endif  // ALCOVE_ALCOVE_RESULT_H_
