// Alcove from C: ambient occlusion recorded into an engine's own command buffer, on its own device.
//
//   Once:       alcoveCreateContext, and AlcoveSettings from alcoveGetSettings.
//   Each frame: wait for the fence of slot s, call alcoveRecordFrame with a command buffer in the
//               recording state, end the command buffer and submit it with that fence.
//   At the end: alcoveDestroyContext, when the device has finished.
//
// passes/INTEGRATION.md is a guide from an engine with a depth buffer to a picture. This header
// includes those of cameras, memory, reports and results, which stand alone too.
//
// Space. View space is right-handed with the camera along -Z, clip space is Vulkan's (y down, depth
// 0 to 1), matrices are column-major: row r of column c at 4 * c + r. Lengths are in the scene's
// units. A visibility of 1 is open.
//
// Threads. One thread at a time may call functions on a context, which takes no lock. Contexts
// share nothing, not even on one device.
//
// Errors. A call on a context that fails records nothing and changes no history, and
// alcoveGetMessage says in a sentence what was wrong. Where memory runs out or the device is lost
// in the middle of a frame, throw the command buffer away; the next frame may be tried. No
// exception leaves the library, and nothing is printed: AlcoveContextInfo::log gets every sentence.
//
// Versions. A struct that may grow begins with struct_size, which the caller sets to sizeof the
// struct. It tells the library which version of this header the caller was compiled with. From the
// first release on, structs grow at their end, fields that an older caller does not have stay off,
// and values of enums do not change.
#ifndef ALCOVE_ALCOVE_H_
#define ALCOVE_ALCOVE_H_

#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan_core.h>

#include "alcove/alcove_camera.h"
#include "alcove/alcove_diagnose.h"
#include "alcove/alcove_memory.h"
#include "alcove/alcove_result.h"

#ifdef __cplusplus
extern "C" {
#endif

// Presets for alcoveGetSettings. Fields that the table does not have are the defaults that
// AlcoveSettings states. REFERENCE also has FLOAT32 and, in its advanced settings, the paper's
// horizons and no filter; CONSOLE also has half_resolution.
//
//              slices  steps  tile_size  history_frames  depth fetches a pixel and frame
//   CONSOLE         1      8        8              32                              0.25
//   LOW             1      8        4              32                                1
//   MEDIUM          1     10        2              32                                5
//   HIGH            2     16        2              32                               16
//   REFERENCE      32     64        1               0                             4096
typedef enum AlcoveQuality {
  ALCOVE_QUALITY_CONSOLE = 0,  // traces one of 8x8 pixels in each frame, filters at half resolution
  ALCOVE_QUALITY_LOW = 1,      // traces one of 4x4 pixels in each frame
  ALCOVE_QUALITY_MEDIUM = 2,   // traces one of 2x2; the preset to begin with
  ALCOVE_QUALITY_HIGH = 3,     // MEDIUM with two slices and more steps
  ALCOVE_QUALITY_REFERENCE = 4,  // traces every pixel: a static image to compare with
  ALCOVE_QUALITY_MAX_ENUM = 0x7fffffff
} AlcoveQuality;

// How specular occlusion is computed, if AlcoveView::specular has an image.
typedef enum AlcoveSpecular {
  // Integrates the GGX lobe over the slices that visibility is computed from: the most exact.
  ALCOVE_SPECULAR_SLICES = 1,
  // The next two use visibility and the bent normal, which are then computed too.
  ALCOVE_SPECULAR_TABLE = 2,  // the GGX lobe within the visibility cone, by a 54 KiB table
  ALCOVE_SPECULAR_CONE = 3,   // the exact intersection of two cones
  ALCOVE_SPECULAR_MAX_ENUM = 0x7fffffff
} AlcoveSpecular;

// How AlcoveView::normals holds normals. The decoded vectors may have any length but 0.
typedef enum AlcoveNormalEncoding {
  // xyz in a signed or float format of at least 3 channels.
  ALCOVE_NORMAL_ENCODING_SIGNED_XYZ = 0,
  // xyz packed into [0,1], 0.5 + 0.5 * normal, in any format of at least 3 channels:
  // A2B10G10R10_UNORM, R8G8B8A8_UNORM.
  ALCOVE_NORMAL_ENCODING_UNSIGNED_XYZ = 1,
  // The octahedral map (Cigolle et al. 2014) in xy of a signed or float format.
  ALCOVE_NORMAL_ENCODING_OCTAHEDRAL = 2,
  // The octahedral map packed into [0,1], in any format of at least 2 channels.
  ALCOVE_NORMAL_ENCODING_UNSIGNED_OCTAHEDRAL = 3,
  ALCOVE_NORMAL_ENCODING_MAX_ENUM = 0x7fffffff
} AlcoveNormalEncoding;

// The channels of AlcoveView::visibility that visibility is written to.
typedef enum AlcoveChannel {
  ALCOVE_CHANNEL_ALL = 0,  // every channel: the image holds visibility alone
  // One channel. The others keep their contents.
  ALCOVE_CHANNEL_R = 1,
  ALCOVE_CHANNEL_G = 2,
  ALCOVE_CHANNEL_B = 3,
  ALCOVE_CHANNEL_A = 4,
  ALCOVE_CHANNEL_MAX_ENUM = 0x7fffffff
} AlcoveChannel;

// The precision of intermediate results that have no image of the engine. Images have their own.
typedef enum AlcovePrecision {
  ALCOVE_PRECISION_UNORM8 = 0,   // 8 bits a channel
  ALCOVE_PRECISION_FLOAT16 = 1,  // half floats
  ALCOVE_PRECISION_FLOAT32 = 2,  // floats
  ALCOVE_PRECISION_MAX_ENUM = 0x7fffffff
} AlcovePrecision;

struct AlcoveAdvancedSettings;  // alcove_advanced.h

// Fill it with alcoveGetSettings, then change individual fields. Values in square brackets are the
// defaults of all qualities except REFERENCE. If a value is out of range, the call fails with
// ALCOVE_ERROR_INVALID_INPUT, and alcoveGetMessage names the field and its range.
typedef struct AlcoveSettings {
  uint32_t struct_size;  // sizeof(AlcoveSettings)
  // The largest distance of an occluder in scene units, above 0. A twentieth to a fifth of a room's
  // height is usual.
  float radius;
  // One pixel of a tile of tile_size x tile_size pixels is traced in each frame: 1, 2, 4 or 8. The
  // traced pixel changes from frame to frame, so that every pixel is traced in time.
  uint32_t tile_size;
  // Slices of a traced pixel, 1 to 64. A slice is a plane through the view direction, in which
  // depth is sampled in both directions. More slices have less noise and cost proportionally more.
  uint32_t slices;
  // Samples in each of the two directions of a slice, 2 to 64. More find thinner occluders.
  uint32_t steps;
  // The thickness of occluders as a fraction of the radius, at least 0. At its leading edge an
  // occluder is at most as thick as its visible width. [0.15]
  float thickness;
  // The fraction of the volume hidden behind an occluder that is treated as solid, 0 to 1. It grows
  // with the occluder's width in the image: more behind a wall than behind a twig. [0.33]
  float hidden_occlusion;
  uint32_t depth_layers;  // the depth layers that are searched: 1, or 2 with second_depth [1]
  // The number of frames that are averaged, 0 to 127. More have less noise and follow changes more
  // slowly. 0 keeps no history, and takes no memory for one.
  uint32_t history_frames;
  // Filters and accumulates texels of 2x2 pixels, then upsamples along depth edges: less time, less
  // memory for the history, and a larger error. Needs a tile_size of at least 2. [VK_FALSE, but
  // VK_TRUE for CONSOLE]
  VkBool32 half_resolution;
  AlcoveSpecular specular;     // read if AlcoveView::specular is given [SLICES]
  float roughness;             // perceptual, 0 to 1, for pixels without AlcoveView::roughness [0.5]
  uint32_t roughness_channel;  // the channel of AlcoveView::roughness, 0 to 3 [0]
  AlcovePrecision precision;   // of intermediate results [UNORM8]
  // The visibility that is written is 1 - intensity * (1 - visibility^power), clamped to [0,1]. 1
  // and 1 change nothing and cost nothing. Multi-bounce, and the specular models TABLE and CONE,
  // read what is written.
  float power;      // above 0, at most 16 [1]
  float intensity;  // 0 to 16 [1]
  // Settings that most engines never change. Null: the defaults, which suit every scene. [null]
  const struct AlcoveAdvancedSettings* advanced;
} AlcoveSettings;

// Fills `settings`, whose struct_size must be set, with a preset. `radius` is in scene units and
// above 0. For REFERENCE, `advanced` then points to constants of the library. Returns
// ALCOVE_ERROR_INVALID_INPUT if an argument is invalid; there is no message, because there is no
// context.
AlcoveResult alcoveGetSettings(AlcoveQuality quality, float radius, AlcoveSettings* settings);

// Writes the settings, those of `advanced` too, as lines of `name = value`: at most `size` bytes
// with the terminating zero. A float is the shortest text that reads back as the same, in every
// locale. Returns the bytes that the whole text takes without that zero, 0 if the settings are
// invalid. `text` may be null if `size` is 0.
size_t alcovePrintSettings(const AlcoveSettings* settings, char* text, size_t size);

typedef enum AlcoveSeverity {
  ALCOVE_SEVERITY_INFO = 0,     // device memory was allocated, a pipeline was created
  ALCOVE_SEVERITY_WARNING = 1,  // it works, but something should be changed
  ALCOVE_SEVERITY_ERROR = 2,    // a call has failed: the sentence is its message
  ALCOVE_SEVERITY_MAX_ENUM = 0x7fffffff
} AlcoveSeverity;

// The engine's log. `write` receives sentences, each of which is valid during the call only. It
// must not call the library. If it is null, nothing is logged.
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
  // It has Vulkan 1.3, or 1.2 with the extension VK_KHR_synchronization2. A shader must be able to
  // bind 8 storage images (maxPerStageDescriptorStorageImages).
  VkPhysicalDevice physical_device;
  // With the features synchronization2 and shaderStorageImageWriteWithoutFormat enabled. Where the
  // instance was created for Vulkan 1.2, VK_KHR_synchronization2 is enabled as well.
  VkDevice device;
  PFN_vkGetInstanceProcAddr get_instance_proc_addr;
  // The features that the device was created with, chained as for vkCreateDevice. If given,
  // alcoveCreateContext fails with a message that names the first needed feature that is not
  // enabled. Null: the library only checks that the physical device supports the features.
  const VkPhysicalDeviceFeatures2* enabled_features;
  uint32_t frames_in_flight;  // 1 to ALCOVE_MAX_FRAMES_IN_FLIGHT
  VkBool32 debug_utils;       // VK_EXT_debug_utils is enabled: passes and images get names
  VkBool32 timestamps;        // the device times each pass: alcoveGetTimings
  // The engine's cache, in which pipelines are looked up and stored; null: none. The engine loads,
  // saves and destroys it. Vulkan synchronises it, so that other threads and contexts may use it at
  // the same time. If it was created with VK_PIPELINE_CACHE_CREATE_EXTERNALLY_SYNCHRONIZED_BIT,
  // none of them may while a frame of this context is prepared or recorded.
  VkPipelineCache pipeline_cache;
  // Given to every function of Vulkan that creates or destroys an object; null: the driver's own.
  // The library's own host memory, a few kilobytes, comes from malloc and operator new.
  const VkAllocationCallbacks* allocation_callbacks;
  // Sources of device memory. Images come from `memory_block`, if its `memory` is not null. If
  // there is no block or it is full, they come from `memory_functions`, if given. Without functions
  // a full block fails the frame with ALCOVE_ERROR_OUT_OF_DEVICE_MEMORY. vkAllocateMemory is called
  // if neither is given, and, if only a block is given, for the parameters that the host writes (80
  // KiB per frame in flight).
  AlcoveMemoryFunctions memory_functions;
  AlcoveMemoryBlock memory_block;
  AlcoveLog log;
} AlcoveContextInfo;

// Creates a context on the engine's device. `message` may be null; otherwise it has room for
// ALCOVE_MAX_MESSAGE bytes and receives the sentence of the error, or an empty text if there is
// none. On an error *context is null.
AlcoveResult alcoveCreateContext(const AlcoveContextInfo* info, AlcoveContext** context,
                                 char* message);

// Destroys a context. The device must have finished all of its frames. A null context is allowed.
void alcoveDestroyContext(AlcoveContext* context);

// Returns the message of the last call on this context that failed, or an empty text if none has.
// The result is never null and is valid until the next call.
const char* alcoveGetMessage(const AlcoveContext* context);

// How an image is used before or after a frame. Work on another queue is ordered by the engine's
// semaphores: give the stages at which the context's queue waits for the semaphore, or
// VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, and no access.
typedef struct AlcoveState {
  VkPipelineStageFlags2 stages;
  VkAccessFlags2 access;
  VkImageLayout layout;
} AlcoveState;

// An image of the engine: 2D, optimal tiling, one mip, one sample, of the queue family of the
// context or shared. Zeroed: there is none.
typedef struct AlcoveImage {
  VkImage image;
  // 2D, of the layer, of the depth aspect alone in formats that have it: Vulkan allows no shader to
  // read a view of depth and stencil together. Null: the library makes one and keeps it; call
  // alcoveForgetImage before the image is destroyed.
  VkImageView view;
  VkFormat format;
  // The size in pixels of the part that is read or written, from the top left corner: the whole
  // image, or less with dynamic resolution. All images of a view have the same, except with
  // AlcoveView::half_size_outputs. The other pixels of an output keep their contents, unless it
  // comes in VK_IMAGE_LAYOUT_UNDEFINED.
  uint32_t width;
  uint32_t height;
  uint32_t layer;  // of an array image, such as one layer for each eye
  // The usage that the image was created with. Inputs need SAMPLED. Outputs need STORAGE;
  // visibility also needs SAMPLED with visibility_channel, with multi-bounce and with a specular
  // model other than SLICES, and bent normals with the models that read them.
  VkImageUsageFlags usage;
  // The samples of a pixel that the image was created with; 0 stands for 1. Images of several
  // samples are refused in a sentence: the engine resolves them first, depth and normals to sample
  // 0 (VK_RESOLVE_MODE_SAMPLE_ZERO_BIT, for colour a shader that reads sample 0), because an
  // average of several surfaces lies on none of them.
  uint32_t samples;
  // The last use before the frame (of an input the last write, of an output the last read or write)
  // and the layout at that time. The first barrier waits for these stages. An output may come in
  // VK_IMAGE_LAYOUT_UNDEFINED, because all of its pixels are overwritten, unless only one channel
  // is.
  AlcoveState initial_state;
  // The next use, and its layout: the last barrier changes the layout and makes the image visible
  // to these stages, even if no pass reads it. Required.
  AlcoveState final_state;
} AlcoveImage;

// One view of a frame, such as an eye or a part of a split screen, with images or layers of its
// own. An output without an image is not computed and costs neither a pass nor memory.
typedef struct AlcoveView {
  uint32_t struct_size;
  // Any number that no other view of the frame has. Each id has a history of its own, which is kept
  // until alcoveDropView.
  uint32_t id;
  // Begin a new history, after a cut for example. A change of size does so by itself, except within
  // largest_width and largest_height.
  VkBool32 reset_history;
  VkBool32 normals_in_view_space;  // else in world space
  AlcoveNormalEncoding normal_encoding;
  // Normals in view space have a z that grows away from the eye, as in engines whose camera looks
  // along +Z. Bent normals are written so too.
  VkBool32 normals_forward_z;
  // How many frames in a row, this one included, show exactly the same as the frame before. 0 if
  // this frame differs, or if the engine does not know. Start again at 0 after reset_history and
  // where size, settings or outputs change. From 1 on, `motion` is not read. From 16 on, only the
  // pixels around traced ones are updated, and all frames have the same weight.
  uint32_t static_frames;
  const AlcoveSettings* settings;
  AlcoveCamera camera;
  // The camera with which this id was last recorded. It is not read, and may be zeros, in an id's
  // first frame, with reset_history, without history_frames and by alcovePrepareFrame.
  AlcoveCamera previous_camera;
  // Dynamic resolution: the history has room for this size, and continues while the size of depth
  // changes within it. Zeros: the size of depth, and a change of size begins a new history. A
  // change of the largest size always does. largest_width, largest_height, previous_width and
  // previous_height are not read if history_frames is 0.
  uint32_t largest_width;
  uint32_t largest_height;
  // The size of depth when this id was last recorded. Zeros: the same as now. Not read with
  // reset_history.
  uint32_t previous_width;
  uint32_t previous_height;

  // Inputs.
  //
  // Depth as clip_from_view gives it, in any depth format or R32_SFLOAT. Required.
  //
  // The search knows the step between neighbouring values of the format, in scene units: at a
  // distance z about z^2 / near * 6e-8 for floats that are not reversed, z * 1.2e-7 for reversed
  // floats, z^2 / near / 65535 for 16 bits. Samples within one step of the tangent plane do not
  // occlude. Up to a step of a quarter of the radius occlusion is complete; from there it fades,
  // and from a step of one radius on everything is open, because the depth buffer holds no detail
  // of that size. Reverse depth, or move the near plane away, if distant occlusion is missing.
  AlcoveImage depth;
  // Unit vectors, as normal_encoding says. Without an image, normals are made from
  // depth, and bent normals are in view space.
  //
  // A normal that faces away from the eye by more than 14 degrees is flipped, so that double-sided
  // surfaces may have either sign. One that faces away by less is flipped or bent until it is
  // edge-on, as the depth buffer shows the surface. A normal that is zero or not finite is taken
  // from depth at its pixel.
  AlcoveImage normals;
  // How each surface moved on the image, in xy of a signed format. Without an image only the camera
  // moves. With one, history is held to what the last few frames say, because occluders may move:
  // leave it out if nothing but the camera moves.
  //
  // motion_scale * vector + motion_offset is uv in this frame's image minus uv in the last frame's,
  // y down, with the jitter of both cameras. A scale of zeros stands for 1 and 1. Vectors in pixels
  // have a scale of 1 / size, those in normalised device coordinates 0.5 (y down, as Vulkan has
  // it), those from this frame to the last -1. Vectors that were drawn without jitter have an
  // offset: this frame's jitter minus the last frame's, in uv.
  AlcoveImage motion;
  float motion_scale[2];
  float motion_offset[2];
  AlcoveImage roughness;  // perceptual, [0,1]; without an image, AlcoveSettings::roughness
  // The depth of the nearest back faces: the scene drawn with front faces culled, otherwise as
  // depth. Required with ALCOVE_THICKNESS_UNIT_BACK_FACES (alcove_advanced.h), else not read.
  AlcoveImage back_depth;
  // The second depth layer: the scene drawn with back faces culled, discarding fragments that are
  // not behind `depth` by a thousandth of their distance, otherwise as depth. Required with two
  // depth_layers, else not read.
  AlcoveImage second_depth;
  AlcoveImage albedo;  // linear RGB, [0,1], for multi_bounce

  // Outputs, in any format that the device can store to and that has enough channels. The sky
  // (depth at the far plane, or not a number) is open, and its bent normal is the normal.
  AlcoveImage visibility;  // one channel, [0,1], 1 is open; R8_UNORM is enough
  // One channel of `visibility` to write, if that is an image of the engine that holds something
  // else in its other channels, such as a g-buffer with occlusion in alpha. They keep their
  // contents. The image then comes with contents, in a layout other than UNDEFINED, has the usages
  // STORAGE and SAMPLED, and an unsigned normalised or float format with the channel, without sRGB
  // and without a shared exponent. It must not be an input of the frame. It costs a read of the
  // image. [ALCOVE_CHANNEL_ALL]
  AlcoveChannel visibility_channel;
  // The outputs have half of depth's size, rounded up, and no upsampling pass is run: for engines
  // that upsample themselves. Needs AlcoveSettings::half_resolution. Texel (x, y) belongs to one of
  // the 2x2 pixels whose first is (2x, 2y): to the nearest of them if x + y is even, and otherwise
  // to the farthest that is not the sky. Where 2x2 pixels are one surface, it is the mean of that
  // surface around their common corner. Specular occlusion then needs the model SLICES, and
  // multi-bounce is refused. [VK_FALSE]
  VkBool32 half_size_outputs;
  // Three channels, signed: the mean visible direction, a unit vector in the space of the normals.
  // R8G8B8A8_SNORM is enough.
  AlcoveImage bent_normal;
  AlcoveImage specular;      // one channel, [0,1]: multiplies specular probe light
  AlcoveImage multi_bounce;  // three channels, [0,1]: visibility with light reflected by occluders
} AlcoveView;

typedef struct AlcoveFrame {
  uint32_t struct_size;
  // The number of the frame: it rotates the noise and selects the traced pixels. Must count up.
  uint32_t index;
  // The frame in flight, below frames_in_flight. The device must have finished what was last
  // recorded with this slot. Frames that are recorded separately, of a reflection for example, need
  // a slot of their own.
  uint32_t slot;
  uint32_t view_count;  // 1 to ALCOVE_MAX_VIEWS
  const AlcoveView* views;
  // For alcoveDiagnose: also samples depth and normals of the first view, in a small pass of its
  // own, and reads them when the slot is recorded again. Takes 0.1 MB per frame in flight.
  VkBool32 diagnose_pixels;
} AlcoveFrame;

// Creates the pipelines of this frame and of all frames with the same settings, the same images
// given and the same kind of projection (perspective or not, reversed or not), whether they are a
// view's first, after a cut, in motion or static. Sizes, ids, cameras and the radius make no
// difference. Records nothing, changes no history and touches no image; the first frame allocates
// the memory.
//
// Call it while loading, and before settings change. The driver may take seconds. If another thread
// records meanwhile, prepare with a second context that has the same pipeline_cache, and destroy
// that context: the first one then finds the pipelines in the cache.
//
// Returns the same errors as alcoveRecordFrame.
AlcoveResult alcovePrepareFrame(AlcoveContext* context, const AlcoveFrame* frame);

// Records the passes of all views into `commands`: a primary or secondary command buffer in the
// recording state, of the context's queue family, outside a render pass. Submit frames in the order
// in which they were recorded, each once and all to one queue; call alcoveDiscardFrame for a frame
// that is not submitted. A frame like the one before allocates nothing.
//
// Pipelines that are missing are created now, which may take the driver a second: see
// alcovePrepareFrame.
//
// It leaves compute pipelines and descriptor set 0 bound and touches no other state. Barriers move
// each image from its initial_state to SHADER_READ_ONLY_OPTIMAL (inputs) or GENERAL (outputs)
// before its first use, and to its final_state after the last. Other barriers concern the library's
// own memory only, except that a frame which differs from the one before begins with a full
// barrier. One image may be several inputs if it is described the same way; an output must be
// nothing else.
//
// Errors, with nothing recorded: a null pointer, a size that is zero or above the largest, an
// unknown enum value, a number that is out of range or not finite, a format or usage that cannot be
// used, images of different sizes, a frame without a view, a view without an output.
AlcoveResult alcoveRecordFrame(AlcoveContext* context, VkCommandBuffer commands,
                               const AlcoveFrame* frame);

// Call this instead of submitting the frame that was just recorded, before any other call on the
// context: when the window was closed, for example. The context is then as if the frame had not
// been recorded. Without this call the next frames would read histories that were never written.
// After a frame that failed, or before the first, there is nothing to do.
AlcoveResult alcoveDiscardFrame(AlcoveContext* context);

// Removes a view and its history. The memory is freed while the next frames are recorded, after the
// device has finished the frames that used it. An id that was never recorded is allowed.
AlcoveResult alcoveDropView(AlcoveContext* context, uint32_t id);

// Call this before the engine destroys an image that it gave without a view, because another image
// may get the same handle. An image that was never given is allowed.
AlcoveResult alcoveForgetImage(AlcoveContext* context, VkImage image);

#ifdef __cplusplus
}
#endif

#endif  // ALCOVE_ALCOVE_H_
