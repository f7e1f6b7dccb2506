// The C interface of Alcove. It records ambient occlusion into an engine's own command buffer, on
// the engine's own device.
//
//   Once:       alcoveCreateContext, and alcoveGetSettings for the settings.
//   Each frame: wait for the fence of frame slot s, call alcoveRecordFrame with a command buffer in
//               the recording state, end the command buffer and submit it with that fence.
//   At the end: alcoveDestroyContext, after the device has finished.
//
// passes/INTEGRATION.md is a guide from an engine with a depth buffer to a picture. This header
// includes those of cameras, memory, reports and results; each of them can also be included alone.
//
// Space. View space is right-handed with the camera along -Z. Clip space is Vulkan's: y down, depth
// 0 to 1. Matrices are column-major: row r of column c is element 4 * c + r. Lengths are in the
// scene's units. A visibility of 1 is open.
//
// Threads. Only one thread at a time may call functions on a context, because a context takes no
// lock. Contexts share nothing, not even on one device.
//
// Errors. A call that fails changes no history, and alcoveGetMessage describes the error in a
// sentence. It records nothing, unless memory runs out or the device is lost in the middle of a
// frame: discard the command buffer then. After running out of memory, the next frame can be tried;
// after losing the device, destroy the context. No exception leaves the library. It prints nothing:
// all sentences go to AlcoveContextInfo::log.
//
// Versions. A struct that may grow begins with struct_size, which the caller sets to the sizeof of
// the struct. It tells the library which version of this header the caller was compiled with. From
// the first release on, such structs grow only at their end, fields that an older caller does not
// have are off, and values of enums and structs without struct_size do not change.
#ifndef ALCOVE_ALCOVE_H_
#define ALCOVE_ALCOVE_H_

#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan_core.h>

#include "alcove/alcove_diagnose.h"
#include "alcove/alcove_memory.h"
#include "alcove/alcove_result.h"
#include "alcove/alcove_view.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum AlcoveSeverity {
  ALCOVE_SEVERITY_INFO = 0,     // device memory was allocated, a pipeline was created
  ALCOVE_SEVERITY_WARNING = 1,  // it works, but something should be changed
  ALCOVE_SEVERITY_ERROR = 2,    // a call has failed: the sentence is its message
  ALCOVE_SEVERITY_MAX_ENUM = 0x7fffffff
} AlcoveSeverity;

// The engine's log. `write` receives one sentence at a time, which is valid only during the call,
// and must not call the library. If `write` is null, nothing is logged.
typedef struct AlcoveLog {
  void (*write)(void* user, AlcoveSeverity severity, const char* sentence);
  void* user;
} AlcoveLog;

// The engine's device. All of it, allocators and log included, must outlive the context.
typedef struct AlcoveContextInfo {
  uint32_t struct_size;
  // The family of the queue that frames are submitted to. It must have VK_QUEUE_COMPUTE_BIT.
  uint32_t queue_family;
  VkInstance instance;  // created for Vulkan 1.2 or newer
  // The physical device. It must support Vulkan 1.3, or 1.2 with the extension
  // VK_KHR_synchronization2, and at least 6 storage images per shader stage
  // (maxPerStageDescriptorStorageImages).
  VkPhysicalDevice physical_device;
  // The device. It must have been created with the features synchronization2 and
  // shaderStorageImageWriteWithoutFormat. If the instance was created for Vulkan 1.2, the extension
  // VK_KHR_synchronization2 must be enabled as well.
  VkDevice device;
  PFN_vkGetInstanceProcAddr get_instance_proc_addr;
  // The features that the device was created with, chained as for vkCreateDevice, in any order: the
  // first struct may be another one, cast to this type. VkPhysicalDeviceFeatures2 is one of them.
  // If given, alcoveCreateContext fails with a message that names the first needed feature that is
  // not enabled. Null: the library only checks that the physical device supports the features.
  const VkPhysicalDeviceFeatures2* enabled_features;
  uint32_t frames_in_flight;  // 1 to ALCOVE_MAX_FRAMES_IN_FLIGHT
  VkBool32 debug_utils;       // VK_EXT_debug_utils is enabled: passes and images get names
  VkBool32 timestamps;        // the device times each pass: alcoveGetTimings
  // The engine's pipeline cache, in which the library looks up and stores pipelines, or null for
  // none. The engine loads, saves and destroys it. Vulkan synchronises it, so other threads and
  // contexts may use it at the same time. If it was created with
  // VK_PIPELINE_CACHE_CREATE_EXTERNALLY_SYNCHRONIZED_BIT, nothing else may use it while a frame of
  // this context is prepared or recorded.
  VkPipelineCache pipeline_cache;
  // The allocation callbacks that the library passes to every Vulkan function that creates or
  // destroys an object. Null selects the driver's own allocator. The library's own host memory, a
  // few kilobytes, comes from malloc and operator new.
  const VkAllocationCallbacks* allocation_callbacks;
  // The source of device memory. If it is not given, memory comes from vkAllocateMemory.
  AlcoveMemoryFunctions memory_functions;
  AlcoveLog log;
} AlcoveContextInfo;

// Creates a context on the engine's device. If `message` is not null, it must have room for
// ALCOVE_MAX_MESSAGE bytes. It receives the sentence of the error, or an empty text if there is
// none. On an error, *context is null.
AlcoveResult alcoveCreateContext(const AlcoveContextInfo* info, AlcoveContext** context,
                                 char* message);

// Destroys a context. The device must have finished all of its frames. A null context is allowed.
void alcoveDestroyContext(AlcoveContext* context);

// Returns the message of the last failed call on this context, or an empty text if no call has
// failed. The result is never null and is valid until the next call.
const char* alcoveGetMessage(const AlcoveContext* context);

// How an image is used before or after a frame. If that use is on another queue, the engine orders
// it with a semaphore. `stages` are then the stages at which the context's queue waits for the
// semaphore, or VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, and `access` is 0.
typedef struct AlcoveState {
  VkPipelineStageFlags2 stages;
  VkAccessFlags2 access;
  VkImageLayout layout;
} AlcoveState;

// An image of the engine: 2D, optimal tiling, one mip. It belongs to the queue family of the
// context, or is shared between families. A struct of zeros means that there is no image.
typedef struct AlcoveImage {
  VkImage image;
  // A 2D view of the layer. For a format with depth and stencil it must show the depth aspect only,
  // because Vulkan lets no shader read both through one view. If it is null, the library creates a
  // view and keeps it; call alcoveForgetImage before you destroy the image.
  VkImageView view;
  VkFormat format;
  // The size in pixels. With dynamic resolution (AlcoveViewInfo::largest_width) it may be the size
  // of the part in use, which then begins at the top left corner. An output keeps its contents
  // outside of the part that is written, unless its initial layout is VK_IMAGE_LAYOUT_UNDEFINED.
  uint32_t width;
  uint32_t height;
  uint32_t layer;  // of an array image, such as one layer for each eye
  // The usage with which the image was created. Inputs need SAMPLED, outputs need STORAGE.
  // Visibility also needs SAMPLED if multi-bounce or specular occlusion by TABLE is computed. Bent
  // normals need SAMPLED for TABLE.
  VkImageUsageFlags usage;
  // The number of samples per pixel with which the image was created; 0 means 1. Of depth with
  // several samples, a pass copies sample 0, because an average of several
  // surfaces lies on none of them; this takes 4 bytes per pixel of transient memory. Other images
  // must have one sample: the engine must resolve normals to sample 0 first, with a shader that
  // reads it.
  uint32_t samples;
  // The last use of the image before the frame, and its layout at that time. For an input it is the
  // last write, for an output the last read or write. The first barrier waits for these stages. The
  // layout of an output may be VK_IMAGE_LAYOUT_UNDEFINED, because all of its pixels are
  // overwritten, unless other frames write other areas of it.
  AlcoveState initial_state;
  // The next use of the image after the frame, and the layout that it needs. The last barrier
  // changes the layout and makes the image visible to these stages, even if no pass reads it.
  // Required.
  AlcoveState final_state;
} AlcoveImage;

// One view of a frame. Each view has images, layers of images, or areas of images (read_area), of
// its own. Its history is kept until alcoveDropView.
typedef struct AlcoveView {
  uint32_t struct_size;
  AlcoveViewInfo info;
  AlcoveImage images[ALCOVE_IMAGE_COUNT];  // by AlcoveImageRole
} AlcoveView;

typedef struct AlcoveFrame {
  uint32_t struct_size;
  // The number of the frame: it rotates the noise and selects the traced pixels. It should grow by
  // 1 from frame to frame of a view, because a history of every second number has half of the
  // pixels.
  uint32_t index;
  // The number of the frame in flight, below frames_in_flight. The device must have finished the
  // last frame that was recorded with this slot. Frames that are recorded separately, for example
  // of a reflection, need a slot of their own.
  uint32_t slot;
  uint32_t view_count;  // 1 to ALCOVE_MAX_VIEWS
  const AlcoveView* views;
  // Whether alcoveDiagnose may examine pixels: a small additional pass samples depth, normals and
  // motion vectors of the first view, and the samples are read when the slot is recorded again. It
  // takes 0.15 MB, and 0.15 MB more for each frame in flight.
  VkBool32 diagnose_pixels;
} AlcoveFrame;

// Creates the pipelines that a frame needs, whether it is the first frame of a view, follows a
// camera cut, is in motion or static. They also serve all frames that have the same settings, give
// the same images and have the same kind of projection (perspective or not, reversed or not).
// Sizes, ids, cameras and the radius make no difference. Records nothing, changes no history and
// touches no image; the first recorded frame allocates the memory.
//
// Call it while loading, and before settings change. The driver may take seconds. If another thread
// records meanwhile, call this function with a second context that has the same pipeline_cache, and
// destroy that context: the first context then finds the pipelines in the cache.
//
// Returns the same errors as alcoveRecordFrame.
AlcoveResult alcovePrepareFrame(AlcoveContext* context, const AlcoveFrame* frame);

// Records the passes of all views into `commands`, a primary or secondary command buffer of the
// context's queue family that is in the recording state and outside a render pass. Submit frames in
// the order in which they were recorded, each once and all to one queue. Call alcoveDiscardFrame
// for a frame that you do not submit. A frame that repeats the previous one allocates no memory.
//
// Missing pipelines are created now, which may take the driver a second: see alcovePrepareFrame.
//
// After the call, compute pipelines and descriptor set 0 are bound; no other state of the command
// buffer has changed. Barriers move each image from its initial_state to SHADER_READ_ONLY_OPTIMAL
// (inputs) or GENERAL (outputs) before its first use, and to its final_state after the last. Other
// barriers concern the library's own memory only, except that a frame which differs from the
// previous one begins with a full barrier. One image may serve as several inputs if it is described
// in the same way each time. An output must not serve as anything else, except as an output of
// another view, if both have areas (AlcoveViewInfo::read_area).
//
// If the call returns one of these errors, nothing is recorded: a null pointer, a size that is zero
// or above the largest, an unknown enum value, a number that is out of range or not finite, a
// format or usage that cannot be used, images of different sizes, a frame without a view, or a view
// without an output.
AlcoveResult alcoveRecordFrame(AlcoveContext* context, VkCommandBuffer commands,
                               const AlcoveFrame* frame);

// Makes `view` that of frame `number`, counted from 0, of a still image, which takes
// alcoveGetConvergedFrames() frames of a scene and a camera that do not move: sets reset_history in
// the first frame, static_frames, and camera and size of the previous frame. Record and submit the
// frames one after the other with the same images and a growing AlcoveFrame::index. The last one
// has the image. A view with an id of its own, dropped afterwards, does not disturb other views.
AlcoveResult alcoveSetStillFrame(uint32_t number, AlcoveView* view);

// Undoes the effects of alcoveRecordFrame if the frame that was just recorded will not be
// submitted, for example because the window was closed. Call it before any other call on the
// context. The context is then as if the frame had not been recorded. Without this call, the next
// frames would read histories that were never written. After a frame that failed, or before the
// first frame, the call has no effect.
AlcoveResult alcoveDiscardFrame(AlcoveContext* context);

// Removes a view and its history. The memory is freed while later frames are recorded, after the
// device has finished the frames that used it. An id that was never recorded is allowed.
AlcoveResult alcoveDropView(AlcoveContext* context, uint32_t id);

// Makes the library forget the view that it created for an image without a view. Call it before you
// destroy the image, because another image may get the same handle. An image that was never given
// is allowed.
AlcoveResult alcoveForgetImage(AlcoveContext* context, VkImage image);

#ifdef __cplusplus
}
#endif

#endif  // ALCOVE_ALCOVE_H_
