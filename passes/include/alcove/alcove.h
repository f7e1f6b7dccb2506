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
// Errors. A call that fails records nothing and changes no history, and alcoveGetMessage describes
// the error in a sentence. If memory runs out or the device is lost in the middle of a frame,
// discard the command buffer. After running out of memory, the next frame can be tried; after
// losing the device, destroy the context. No exception leaves the library. It prints nothing: all
// sentences go to AlcoveContextInfo::log.
//
// Versions. A struct that may grow begins with struct_size, which the caller sets to the sizeof of
// the struct. It tells the library which version of this header the caller was compiled with. From
// the first release on, structs grow only at their end, fields that an older caller does not have
// are off, and values of enums do not change.
#ifndef ALCOVE_ALCOVE_H_
#define ALCOVE_ALCOVE_H_

#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan_core.h>

#include "alcove/alcove_camera.h"
#include "alcove/alcove_diagnose.h"
#include "alcove/alcove_memory.h"
#include "alcove/alcove_result.h"
#include "alcove/alcove_settings.h"

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
  // The features that the device was created with, chained as for vkCreateDevice. If given,
  // alcoveCreateContext fails with a message that names the first needed feature that is not
  // enabled. Null: the library only checks that the physical device supports the features.
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
  // The sources of device memory. Images come from `memory_block`, if its `memory` is not null. If
  // there is no block or it is full, they come from `memory_functions`, if given. A full block
  // without functions fails the frame with ALCOVE_ERROR_OUT_OF_DEVICE_MEMORY. If neither is given,
  // all memory comes from vkAllocateMemory. If only a block is given, the parameters that the host
  // writes (80 KiB per frame in flight) come from vkAllocateMemory.
  AlcoveMemoryFunctions memory_functions;
  AlcoveMemoryBlock memory_block;
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
  // The size in pixels. All inputs of a view must have the same size. Outputs have it too, except
  // with areas (AlcoveView::read_area). With dynamic resolution (AlcoveView::largest_width) it may
  // be the size of the part in use, which then begins at the top left corner. An output keeps its
  // contents outside of the part that is written, unless its initial layout is
  // VK_IMAGE_LAYOUT_UNDEFINED.
  uint32_t width;
  uint32_t height;
  uint32_t layer;  // of an array image, such as one layer for each eye
  // The usage with which the image was created. Inputs need SAMPLED, outputs need STORAGE.
  // Visibility also needs SAMPLED if multi-bounce or specular occlusion by TABLE or CONE is
  // computed. Bent normals need SAMPLED for TABLE and CONE.
  VkImageUsageFlags usage;
  // The number of samples per pixel with which the image was created; 0 means 1. Of
  // AlcoveView::depth with several samples, a pass copies sample 0, because an average of several
  // surfaces lies on none of them; this takes 4 bytes per pixel of transient memory. Other images
  // must have one sample: the engine must resolve normals to sample 0 first, with a shader that
  // reads it.
  uint32_t samples;
  // The last use of the image before the frame, and its layout at that time. For an input it is the
  // last write, for an output the last read or write. The first barrier waits for these stages. The
  // layout of an output may be VK_IMAGE_LAYOUT_UNDEFINED, because all of its pixels are
  // overwritten. It may not be if only one channel is written.
  AlcoveState initial_state;
  // The next use of the image after the frame, and the layout that it needs. The last barrier
  // changes the layout and makes the image visible to these stages, even if no pass reads it.
  // Required.
  AlcoveState final_state;
} AlcoveImage;

// One view of a frame, such as an eye or a part of a split screen. Each view has images, layers of
// images, or areas of images (read_area), of its own. An output without an image is not computed,
// and costs no pass and no memory.
typedef struct AlcoveView {
  uint32_t struct_size;
  // The number that identifies the view, different from those of the frame's other views. Each id
  // has its own history, which is kept until alcoveDropView.
  uint32_t id;
  // Whether the view begins a new history, for example after a camera cut. A change of size begins
  // a new history in any case, unless the size stays within largest_width and largest_height.
  VkBool32 reset_history;
  VkBool32 normals_in_view_space;  // else in world space
  AlcoveNormalEncoding normal_encoding;
  // Whether normals in view space have a z axis that points away from the eye, as in engines whose
  // camera looks along +Z. Bent normals are then written with the same axis.
  VkBool32 normals_forward_z;
  // The number of consecutive frames, up to and including this one, whose image is exactly that of
  // the frame before. It is 0 if this frame differs from the previous one, or if the engine does
  // not know. It must start again at 0 after reset_history and when the size, the settings or the
  // outputs change. If it is at least 1, `motion` is not read. If it is at least 16, the history
  // averages up to 127 frames.
  uint32_t static_frames;
  const AlcoveSettings* settings;
  AlcoveCamera camera;
  // The camera with which this id was last recorded. It is not read, and may be zero, in the first
  // frame of an id, with reset_history, if history_frames is 0, and by alcovePrepareFrame.
  AlcoveCamera previous_camera;
  // The largest size of the depth image, or of read_area, for dynamic resolution. The history has
  // room for this size, and continues while the size changes within it. Zero means the current
  // size; a change of size then begins a new history. A change of the largest size always does.
  uint32_t largest_width;
  uint32_t largest_height;
  // The size of the depth image, or of read_area, when this id was last recorded. Zero means the
  // current size. Not read with reset_history, nor if history_frames is 0.
  uint32_t previous_width;
  uint32_t previous_height;

  // Areas, for several views in one image (split screen, stereo side by side, viewports of an
  // editor) and for a guard band. If all of these fields are 0, images are read and written as a
  // whole, which takes up to 5 % less time (alcove cost --area).
  //
  // The area of the inputs that is read. The cameras describe it, and uv and sizes of motion
  // vectors refer to it. Pixels outside of it are not read. Zeros mean the whole images.
  AlcoveArea read_area;
  // The area for which results are computed, in pixels of the inputs, within read_area. Zeros mean
  // read_area. If it is smaller, the rest of read_area is a guard band: occluders in it are found,
  // and occlusion does not fade towards the border of the picture. The guard band is not traced,
  // apart from its innermost tiles. Set reset_history when the distances between the borders of the
  // two areas change.
  AlcoveArea written_area;
  // The position of the results in the output images, whose other pixels are not written.
  uint32_t output_x;
  uint32_t output_y;

  // Inputs.
  //
  // The depth buffer, as clip_from_view gives depths, in any depth format or R32_SFLOAT. Required.
  //
  // Samples within one depth step of the tangent plane do not occlude. A depth step is the distance
  // in scene units between two successive depths that the format can store. At the distance z it is
  // about z^2 / near * 6e-8 for floats that are not reversed, z * 1.2e-7 for reversed floats, and
  // z^2 / near / 65535 for 16 bits. While the step grows from a quarter of the radius to the
  // radius, occlusion fades, and beyond that the visibility is 1, because the depth buffer then
  // holds no detail of that size. If distant occlusion is missing, reverse the depth or move the
  // near plane away from the eye.
  AlcoveImage depth;
  // The format in which the depths were first stored, if `depth` is a copy in another format.
  // UNDEFINED means the format of `depth`. [VK_FORMAT_UNDEFINED]
  VkFormat depth_format;
  // The unit normals of the surfaces, encoded as normal_encoding says. Without an image, normals
  // are computed from depth, and bent normals are in view space.
  //
  // A normal that faces away from the eye by more than 14 degrees is flipped, so that double-sided
  // surfaces may have either sign. A normal that faces away by less is either flipped or rotated
  // until it is perpendicular to the view direction; the normal from depth decides which. A normal
  // that is zero or not finite is replaced by the normal from depth.
  AlcoveImage normals;
  // Motion vectors: how far each surface moved on the image, in x and y of a signed format. Without
  // an image, only the camera is assumed to move. With an image, occluders may move too, and the
  // history is replaced where it differs from the last few frames. Leave the image out if nothing
  // but the camera moves.
  //
  // motion_scale * vector + motion_offset must be the uv of a surface in this frame's image minus
  // its uv in the previous frame's image, with y down and with the jitter of both cameras. The
  // scale is 1 / size for vectors in pixels, 0.5 for vectors in normalised device coordinates (with
  // Vulkan's y down), and negative for vectors that point from this frame to the previous one. A
  // scale of zeros means 1 and 1. If the vectors were drawn without jitter, the offset is this
  // frame's jitter minus the previous frame's, in uv.
  AlcoveImage motion;
  float motion_scale[2];
  float motion_offset[2];
  AlcoveImage roughness;  // perceptual, [0,1]; without an image, AlcoveSettings::roughness
  // The depth of the nearest back faces: the scene drawn like `depth`, but with front faces culled.
  // Required with ALCOVE_THICKNESS_UNIT_BACK_FACES, and not read otherwise.
  AlcoveImage back_depth;
  // The second depth layer: the scene drawn like `depth`, but with back faces culled and without
  // the fragments that are not behind `depth` by at least a thousandth of their distance. Required
  // if depth_layers is 2, and not read otherwise.
  AlcoveImage second_depth;
  AlcoveImage albedo;  // linear RGB, [0,1], for multi_bounce
  // A mask of surfaces, R8_UNORM or R8_UINT, for example for emissive or unlit surfaces, for water
  // that is drawn into depth, and for weapons in the hand of the player. Without an image there is
  // no mask. With one, a pass copies depth twice, which takes 8 bytes per pixel of transient
  // memory.
  AlcoveImage mask;
  // Surfaces with one of these bits do not receive occlusion: their visibility and specular
  // occlusion are 1, and their bent normal is the normal (without an image of normals, the
  // direction to the eye). The filter and the history do not mix them with other surfaces.
  uint32_t not_receiving;
  // Surfaces with one of these bits do not occlude. Depth does not tell what lies behind them;
  // these directions count as unobserved, like those behind a distant foreground.
  uint32_t not_occluding;

  // Outputs, in any format with enough channels that the device can store to. The sky (pixels whose
  // depth is at the far plane or is NaN) gets the visibility 1, and its bent normal is the normal.
  AlcoveImage visibility;  // one channel, [0,1], 1 is open; R8_UNORM is enough
  // The mean visible direction: a unit vector in the space of the normals, in three signed
  // channels. R8G8B8A8_SNORM is enough.
  AlcoveImage bent_normal;
  AlcoveImage specular;      // one channel, [0,1]: multiplies specular probe light
  AlcoveImage multi_bounce;  // three channels, [0,1]: visibility with light reflected by occluders
} AlcoveView;

typedef struct AlcoveFrame {
  uint32_t struct_size;
  // The number of the frame: it rotates the noise and selects the traced pixels. Must count up.
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
// another view, if both have areas (AlcoveView::read_area).
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
