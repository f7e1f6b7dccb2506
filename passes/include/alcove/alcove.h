// Alcove from C: ambient occlusion recorded into an engine's own command buffer, on its own device.
//
//   alcoveCreateContext once                 AlcoveSettings from alcoveGetSettings, changed at will
//   frame: wait for the fence of slot s;     alcoveRecordFrame into a command buffer in recording
//          end it, submit it with that fence
//   alcoveDestroyContext when the device has finished, before or after the engine's images go
//
// Space. View space is right-handed with the camera along -Z, clip space is Vulkan's (y down, depth
// 0 to 1), matrices are column-major: row r of column c at 4 * c + r. Lengths are in the scene's
// units. A visibility of 1 is open.
//
// Threads. A context is for one thread at a time, and takes no lock; contexts, also of one device,
// share nothing.
//
// Errors. A call on a context that fails records nothing and changes no history, and
// alcoveGetMessage says in a sentence what was wrong. Where memory or the device gives out in the
// middle of a frame, what was recorded of it, and the command buffer with it, is to be thrown away;
// the next one may be tried. No exception leaves the library, and nothing is printed.
//
// Versions. A struct that may grow begins with struct_size, which the caller sets to sizeof the
// struct: so the library knows which version of this header the caller was compiled with. Structs
// grow at their end, and what an older caller does not have stays off. Values of enums never
// change.
#ifndef ALCOVE_ALCOVE_H_
#define ALCOVE_ALCOVE_H_

#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan_core.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ALCOVE_VERSION VK_MAKE_API_VERSION(0, 0, 1, 0)  // of this header
#define ALCOVE_MAX_VIEWS 8                              // of a frame
#define ALCOVE_MAX_FRAMES_IN_FLIGHT 8
#define ALCOVE_MAX_NAME 32      // of a pass: bytes, terminating zero included
#define ALCOVE_MAX_MESSAGE 512  // the same of a message; longer ones are cut

typedef enum AlcoveResult {
  ALCOVE_SUCCESS = 0,
  ALCOVE_ERROR_INVALID_INPUT = -1,  // what the caller gave
  ALCOVE_ERROR_UNSUPPORTED = -2,    // what the device lacks
  ALCOVE_ERROR_OUT_OF_HOST_MEMORY = -3,
  ALCOVE_ERROR_OUT_OF_DEVICE_MEMORY = -4,
  ALCOVE_ERROR_DEVICE_LOST = -5,  // destroy the context
  ALCOVE_ERROR_VULKAN = -6,       // another of Vulkan's: the message has its number
  ALCOVE_ERROR_INTERNAL = -7,     // the library's own fault
  ALCOVE_RESULT_MAX_ENUM = 0x7fffffff
} AlcoveResult;

// "ALCOVE_SUCCESS" and so on: static, and never null.
const char* alcoveGetResultName(AlcoveResult result);

// ALCOVE_VERSION of the library.
uint32_t alcoveGetVersion(void);

// What alcoveGetSettings gives each quality; all else is the default that AlcoveSettings states,
// and REFERENCE has HORIZONS, no filter and FLOAT32 besides.
//
//              slices  steps  tile_size  history_frames  depth fetches a pixel and frame
//   LOW             1      8        4              32                                1
//   MEDIUM          1     10        2              32                                5
//   HIGH            3     16        2              32                               24
//   ULTRA           4     24        2              32                               48
//   REFERENCE      32     64        1               0                             4096
typedef enum AlcoveQuality {
  ALCOVE_QUALITY_LOW = 0,        // one search in 4x4 pixels a frame
  ALCOVE_QUALITY_MEDIUM = 1,     // one in 2x2: the one to begin with
  ALCOVE_QUALITY_HIGH = 2,       // the same of three slices
  ALCOVE_QUALITY_ULTRA = 3,      // of four, and finer
  ALCOVE_QUALITY_REFERENCE = 4,  // every pixel at once: a still image to compare with
  ALCOVE_QUALITY_MAX_ENUM = 0x7fffffff
} AlcoveQuality;

// What stands behind an occluder's front, which is all that a depth buffer shows.
typedef enum AlcoveEstimator {
  ALCOVE_ESTIMATOR_HORIZONS = 0,   // everything: occluders are infinitely thick
  ALCOVE_ESTIMATOR_HEURISTIC = 1,  // the same, but lower samples further out pull horizons down
  ALCOVE_ESTIMATOR_BITMASK = 2,    // each sample is an occluder alone, as thick as `thickness` says
  ALCOVE_ESTIMATOR_CONNECTED = 3,  // and samples of one surface are joined: thin things and walls
  ALCOVE_ESTIMATOR_MAX_ENUM = 0x7fffffff
} AlcoveEstimator;

// What a visible direction counts in visibility. Bent normals are weighted by the cosine always.
typedef enum AlcoveWeighting {
  ALCOVE_WEIGHTING_COSINE = 0,   // the cosine of its angle to the normal: what diffuse light needs
  ALCOVE_WEIGHTING_UNIFORM = 1,  // 1: the share of the hemisphere's solid angle
  ALCOVE_WEIGHTING_MAX_ENUM = 0x7fffffff
} AlcoveWeighting;

typedef enum AlcoveThicknessUnit {
  ALCOVE_THICKNESS_UNIT_RADIUS = 0,      // parts of the radius: one thickness in the scene
  ALCOVE_THICKNESS_UNIT_DISTANCE = 1,    // parts of the occluder's distance from the eye
  ALCOVE_THICKNESS_UNIT_BACK_FACES = 2,  // AlcoveView::back_depth; the radius where that has none
  ALCOVE_THICKNESS_UNIT_MAX_ENUM = 0x7fffffff
} AlcoveThicknessUnit;

// How directions are spread over pixels and frames.
typedef enum AlcovePattern {
  ALCOVE_PATTERN_GOLDEN = 0,   // 4x4 pixels, turned by the golden ratio each frame
  ALCOVE_PATTERN_HILBERT = 1,  // along a Hilbert curve, by the R2 sequence
  ALCOVE_PATTERN_MEMO = 2,     // the paper's: 4x4 pixels and six rotations in turn
  ALCOVE_PATTERN_MAX_ENUM = 0x7fffffff
} AlcovePattern;

// How specular occlusion is found, where AlcoveView::specular asks for it.
typedef enum AlcoveSpecular {
  ALCOVE_SPECULAR_SLICES = 1,  // by the slices that find visibility: the most exact
  // From visibility and bent normal, which are then made too.
  ALCOVE_SPECULAR_TABLE = 2,        // the lobe itself within a cone, by a table of 54 KiB
  ALCOVE_SPECULAR_CONE = 3,         // two cones, exactly
  ALCOVE_SPECULAR_SMOOTH_CONE = 4,  // two cones, by a smooth step: cheaper, up to 0.16 off
  // From visibility alone.
  ALCOVE_SPECULAR_LAGARDE = 5,  // a fit by Lagarde and de Rousiers
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
  // The same packed into [0,1], in any format of at least 2 channels.
  ALCOVE_NORMAL_ENCODING_UNSIGNED_OCTAHEDRAL = 3,
  ALCOVE_NORMAL_ENCODING_MAX_ENUM = 0x7fffffff
} AlcoveNormalEncoding;

// Of results that others are made from and that no image was given for; an image has its own.
typedef enum AlcovePrecision {
  ALCOVE_PRECISION_UNORM8 = 0,   // 8 bits a channel
  ALCOVE_PRECISION_FLOAT16 = 1,  // half floats
  ALCOVE_PRECISION_FLOAT32 = 2,  // floats
  ALCOVE_PRECISION_MAX_ENUM = 0x7fffffff
} AlcovePrecision;

// From alcoveGetSettings, to be changed at will. A default in brackets is that of every quality but
// REFERENCE. What the estimator or history does not use is not read, but it has to be in range.
typedef struct AlcoveSettings {
  uint32_t struct_size;  // sizeof(AlcoveSettings)

  // The search: in a pixel `slices` planes through the view vector, in each of them `steps` depths
  // on either side.

  // Scene units, over 0: occluders beyond it do not count. A twentieth of a room's height to a
  // fifth of it is usual.
  float radius;
  uint32_t slices;            // 1 to 64
  uint32_t steps;             // on each side of a slice, 2 to 64
  AlcoveEstimator estimator;  // [CONNECTED]
  AlcoveWeighting weighting;  // [COSINE]
  // Of an occluder, in thickness_unit, at least 0; BITMASK and CONNECTED have it. With CONNECTED a
  // surface is where it begins no thicker than it is sure to be wide. [0.15]
  float thickness;
  AlcoveThicknessUnit thickness_unit;  // [RADIUS]; BITMASK and CONNECTED
  // What lies behind an occluder of that thickness is hidden from the eye, and may be open or
  // solid: so much of it counts as solid, 0 nothing to 1 all. In between it is the more, the wider
  // in the image the occluder is: all behind a wall, little behind a twig. [0.33]; BITMASK and
  // CONNECTED
  float hidden_occlusion;
  uint32_t depth_layers;  // that are searched: 1, or 2 with AlcoveView::second_depth [1]; BITMASK
                          // and CONNECTED
  // How far each lower sample further out pulls a horizon down to it, 0 not at all to 1 wholly
  // [0.05]; HEURISTIC.
  float blend;
  // Last part of the radius, over which occluders fade, 0 none to 1 all of it [0]; HORIZONS and
  // HEURISTIC. Must be 0 with BITMASK and CONNECTED, where a direction is occluded or it is not.
  float falloff;
  uint32_t tile_size;     // one search a frame in a block of so many pixels a side: 1, 2 or 4. The
                          // traced pixel of each block moves on from frame to frame
  AlcovePattern pattern;  // [GOLDEN]

  // The filter, in which each pixel gathers searches around it that lie on its surface.
  uint32_t filter_radius;  // traced pixels on each side that it looks at while it has less than
                           // two frames of history, 0 to 3 [2]; then one. 0: no filter at all
  // How far from the pixel's tangent plane a search counts a quarter, over 0, in sizes of a pixel
  // there [1.5]. So in the first frame of one slice; the more slices and frames, the nearer.
  float filter_tolerance_px;

  // The history.
  uint32_t history_frames;  // that are averaged, 0 to 127; 0: no history and no memory for it
  float clamp_width;        // to which it is held, in standard deviations of this frame around the
                            // pixel, at least 0; 0 leaves it free [0]

  // Outputs.
  AlcoveSpecular specular;     // [SLICES]; read where AlcoveView::specular is given
  float roughness;             // perceptual, 0 to 1, of every pixel where no image has it [0.5]
  uint32_t roughness_channel;  // of AlcoveView::roughness, 0 to 3 [0]
  AlcovePrecision precision;   // [UNORM8]
  // What is written as visibility is 1 - intensity * (1 - visibility^power), cut to [0,1]. 1 and 1
  // change nothing and cost nothing. Multi-bounce, and the specular models but SLICES, read what is
  // written.
  float power;      // above 0 to 16 [1]
  float intensity;  // 0 to 16 [1]
} AlcoveSettings;

// Fills `settings`, whose struct_size is set, with those of a quality at a radius (scene units,
// over 0). ALCOVE_ERROR_INVALID_INPUT if any argument is invalid; there is no context, so no
// message.
AlcoveResult alcoveGetSettings(AlcoveQuality quality, float radius, AlcoveSettings* settings);

// Writes the settings as lines of `name = value`, at most `size` bytes with the closing zero. A
// float is the shortest text that reads back as the same, in every locale. Returns the bytes that
// all of it takes without that zero, 0 if the settings are invalid. `text` may be null where `size`
// is 0.
size_t alcovePrintSettings(const AlcoveSettings* settings, char* text, size_t size);

typedef struct AlcoveContext AlcoveContext;

// The engine's own; all of it outlives the context. Memory is the context's own, by
// vkAllocateMemory and the C++ heap: no allocator can be given, and alcoveGetMemory says how much
// it is.
typedef struct AlcoveContextInfo {
  uint32_t struct_size;
  uint32_t queue_family;             // of the queue that frames are submitted to: one that computes
  VkInstance instance;               // as the device, made for Vulkan 1.3
  VkPhysicalDevice physical_device;  // that binds 10 storage images to a shader
  // With the features synchronization2 and shaderStorageImageWriteWithoutFormat enabled.
  VkDevice device;
  PFN_vkGetInstanceProcAddr get_instance_proc_addr;
  // What the device was made with, chained as for vkCreateDevice: then a feature that the engine
  // forgot to enable is named. Null: only what the physical device has is checked.
  const VkPhysicalDeviceFeatures2* enabled_features;
  uint32_t frames_in_flight;  // 1 to ALCOVE_MAX_FRAMES_IN_FLIGHT
  VkBool32 debug_utils;       // VK_EXT_debug_utils is enabled: passes and images get names
  VkBool32 timestamps;        // the device times each pass: alcoveGetTimings
  // Where pipelines are looked up and kept; null: nowhere. The engine loads, stores and destroys
  // it. Vulkan synchronises it, so that other threads and contexts may use it at the same time,
  // unless it was created with VK_PIPELINE_CACHE_CREATE_EXTERNALLY_SYNCHRONIZED_BIT: then none may
  // while a frame of this context is prepared or recorded.
  VkPipelineCache pipeline_cache;
} AlcoveContextInfo;

// `message` may be null; else it has room for ALCOVE_MAX_MESSAGE bytes and gets the sentence where
// there is an error, and is empty where there is none. On an error *context is null.
AlcoveResult alcoveCreateContext(const AlcoveContextInfo* info, AlcoveContext** context,
                                 char* message);

// The device must have finished all that was recorded. Null is fine.
void alcoveDestroyContext(AlcoveContext* context);

// What the last call on this context that failed had to say; empty before there is one. Valid until
// the next call. Never null.
const char* alcoveGetMessage(const AlcoveContext* context);

// What another queue does is ordered by the engine's semaphores: `stages` are then those at which
// the context's queue waits for them, or VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, without access.
typedef struct AlcoveState {
  VkPipelineStageFlags2 stages;
  VkAccessFlags2 access;
  VkImageLayout layout;
} AlcoveState;

// An image of the engine's: 2D, optimal tiling, one mip, one sample, of the queue family of the
// context or shared. Zeroed: there is none. Depth of several samples is resolved by the engine
// first, to that of sample 0 (VK_RESOLVE_MODE_SAMPLE_ZERO_BIT): an average lies on no surface.
typedef struct AlcoveImage {
  VkImage image;
  // 2D, of the layer, of the depth aspect alone in formats that have it: Vulkan allows no shader to
  // read a view of depth and stencil together. Null: the library makes one and keeps it; call
  // alcoveForgetImage before the image is destroyed.
  VkImageView view;
  VkFormat format;
  // Pixels that are read or written, from the first on: all of the image, or fewer (dynamic
  // resolution). Those of a view are alike. The others of an output are left as they were, but that
  // a change from VK_IMAGE_LAYOUT_UNDEFINED forgets them.
  uint32_t width;
  uint32_t height;
  uint32_t layer;  // of an array of images, both eyes' say
  // That the image was made with. Inputs need SAMPLED. Outputs need STORAGE, and SAMPLED where
  // others are made from them: visibility with multi-bounce or a specular model but slices, bent
  // normals with the models that read them.
  VkImageUsageFlags usage;
  // Who wrote it last (of an output: who read or wrote it last), and in which layout it is then.
  // The first barrier waits for these stages. An output may come in VK_IMAGE_LAYOUT_UNDEFINED: all
  // its pixels are overwritten.
  AlcoveState initial_state;
  // Who uses it next, and in which layout: the last barrier puts it there and makes it visible to
  // these stages, also where no pass reads it. Needed.
  AlcoveState final_state;
} AlcoveImage;

// The camera that depth was drawn with, jitter included. Where the viewport has a negative height,
// change the sign of the second row of the engine's clip_from_view. Where the engine's view space
// looks along +Z, change the sign of the third column of clip_from_view, of the third row of
// view_from_world, and of z of normals in view space.
//
// Rounding errors are accepted and removed: elements that should be 0 or 1 may be off by what float
// products and inverses leave there, with fused multiply-adds or without.
typedef struct AlcoveCamera {
  // Any projection: finite, infinite, reversed, off-centre, jittered, flipped in Y, orthographic.
  // In perspective w must be 0 at the eye.
  float clip_from_view[16];
  // A rotation and a translation, without scale; or a reflection and a translation, for left-handed
  // worlds.
  float view_from_world[16];
} AlcoveCamera;

// What an engine's matrices have otherwise than AlcoveCamera: for alcoveConvertCamera, to be
// combined.
typedef enum AlcoveCameraConvention {
  // Clip space has y up: the viewport has a negative height, or the API's y points up.
  ALCOVE_CAMERA_CONVENTION_CLIP_Y_UP = 1,
  // Clip space has depth -1 to 1, which is stored as 0.5 + 0.5 * depth.
  ALCOVE_CAMERA_CONVENTION_DEPTH_FROM_MINUS_ONE = 2,
  // The camera looks along +Z of view space.
  ALCOVE_CAMERA_CONVENTION_FORWARD_Z = 4,
  // Matrices of column vectors lie in memory row by row. (Matrices of row vectors that lie row by
  // row, as those of DirectXMath and Unreal, need no bit: in memory they are the same.)
  ALCOVE_CAMERA_CONVENTION_ROW_MAJOR = 8,

  // glm::perspectiveRH_ZO and glm::lookAtRH, drawn with a viewport of negative height. Where the
  // engine changes the sign of the projection's [1][1] instead, no conversion is needed.
  ALCOVE_CAMERA_CONVENTION_GLM = 1,
  // gluPerspective, glFrustum.
  ALCOVE_CAMERA_CONVENTION_OPENGL = 3,
  // Direct3D, DirectXMath's ...LH functions and Unreal's view and projection matrices.
  ALCOVE_CAMERA_CONVENTION_DIRECT3D = 5,
  ALCOVE_CAMERA_CONVENTION_UNREAL = 5,
  ALCOVE_CAMERA_CONVENTION_MAX_ENUM = 0x7fffffff
} AlcoveCameraConvention;

// Fills `camera` with an engine's matrices of 16 floats each. `conventions` is any combination of
// AlcoveCameraConvention, 0 for none. ALCOVE_ERROR_INVALID_INPUT where a pointer is null or a bit
// is unknown; what the matrices hold is checked when a frame is recorded. Normals in view space of
// a camera that looks along +Z need AlcoveView::normals_forward_z too.
AlcoveResult alcoveConvertCamera(const float* clip_from_view, const float* view_from_world,
                                 uint32_t conventions, AlcoveCamera* camera);

// A perspective in plain numbers.
typedef struct AlcovePerspective {
  uint32_t struct_size;
  float fov_y;        // vertical angle of view in radians, above 0 and below pi
  float near_plane;   // distance in scene units, above 0
  float far_plane;    // above near_plane; 0 or infinity: infinite
  VkBool32 reversed;  // near at depth 1, far at depth 0
  uint32_t width;     // of the image in pixels
  uint32_t height;
  float jitter_px[2];  // by which the image is shifted, in pixels, x right and y down
} AlcovePerspective;

// Fills AlcoveCamera::clip_from_view. ALCOVE_ERROR_INVALID_INPUT where a number is out of range.
AlcoveResult alcoveMakePerspective(const AlcovePerspective* perspective, float* clip_from_view);

// One view of a frame: an eye, a part of a split screen, in images or layers of its own. Outputs
// that have no image are not made, and cost neither a pass nor memory.
typedef struct AlcoveView {
  uint32_t struct_size;
  uint32_t id;             // any number, other in each view of a frame: each id has its own
                           // history, kept until alcoveDropView
  VkBool32 reset_history;  // forget it, at a cut say. A change of size does so by itself, but for
                           // largest_width
  VkBool32 normals_in_view_space;  // else in world space
  AlcoveNormalEncoding normal_encoding;
  // Normals in view space have a z that grows away from the eye, as in engines whose camera looks
  // along +Z. Bent normals are written so too.
  VkBool32 normals_forward_z;
  // Frames in a row, up to this one, that show the very same of this id as the one before each; 0:
  // this one differs, or nobody knows. It starts again after reset_history (with which it is not
  // read) and where size, settings or outputs change. From 1 on `motion` is not read; from 16 on a
  // search at lower resolution brings forward only the pixels that it reached, and all frames
  // count.
  uint32_t static_frames;
  const AlcoveSettings* settings;
  AlcoveCamera camera;
  // The camera with which this id was last recorded. It is not read, and may be zeros, in an id's
  // first frame, with reset_history, without history_frames and by alcovePrepareFrame.
  AlcoveCamera previous_camera;
  // Dynamic resolution: history has room for `largest`, and goes on while the size changes within
  // it. Zeros: it is as large as depth, and a change of size begins it anew. A change of `largest`
  // does in any case. Unread without history_frames, as are the next.
  uint32_t largest_width;
  uint32_t largest_height;
  // Of depth, when this id was last recorded. Zeros: as now. Unread with reset_history.
  uint32_t previous_width;
  uint32_t previous_height;

  // Inputs.
  AlcoveImage depth;  // as clip_from_view has it: any depth format, or R32_SFLOAT. Needed
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
  // leave it out where nothing but the camera does.
  //
  // motion_scale * vector + motion_offset is uv in this frame's image minus uv in the last frame's,
  // y down, with the jitter of both cameras. A scale of zeros stands for 1 and 1. Vectors in pixels
  // have a scale of 1 / size, those in normalised device coordinates 0.5 (y down, as Vulkan has
  // it), those from this frame to the last -1. Vectors that were drawn without jitter have an
  // offset: this frame's jitter minus the last frame's, in uv.
  AlcoveImage motion;
  float motion_scale[2];
  float motion_offset[2];
  AlcoveImage roughness;   // perceptual, [0,1]; none: AlcoveSettings::roughness
  AlcoveImage back_depth;  // of the nearest back faces, as depth; needed with
                           // ALCOVE_THICKNESS_UNIT_BACK_FACES (bitmask, connected), else unread
  // The scene drawn once more into another depth, back faces culled and fragments discarded that do
  // not lie behind `depth` by a thousandth of their distance; as depth. Needed with two
  // depth_layers (bitmask, connected), else unread.
  AlcoveImage second_depth;
  AlcoveImage albedo;  // linear RGB, [0,1], for multi_bounce

  // Outputs. Formats are any that the device can store to, of at least so many channels. The sky
  // (depth at the far plane, or not a number) is open, its bent normal the normal.
  AlcoveImage visibility;    // 1 channel, [0,1]: R8_UNORM will do
  AlcoveImage bent_normal;   // 3, signed: xyz unit, in the space of the normals; R8G8B8A8_SNORM
  AlcoveImage specular;      // 1, [0,1]: multiplies specular probe light
  AlcoveImage multi_bounce;  // 3, RGB, [0,1]: visibility with the light that occluders send back
} AlcoveView;

typedef struct AlcoveFrame {
  uint32_t struct_size;
  uint32_t index;  // counts frames: it turns the noise and moves the traced pixels
  // In flight, below frames_in_flight: what was recorded with it has finished. One that is recorded
  // apart, a reflection's say, is a frame with a slot of its own.
  uint32_t slot;
  uint32_t view_count;  // 1 to ALCOVE_MAX_VIEWS
  const AlcoveView* views;
} AlcoveFrame;

// Makes the pipelines of this frame and of all that have its settings, the same images given and
// the same kind of projection (perspective or not, reversed or not), whatever lies before them: a
// view's first frame, one after a cut, in motion, still. Sizes, ids, cameras and the radius make no
// difference. Records nothing, changes no history and touches no image; memory is left for the
// first frame to allocate.
//
// To be called while loading, and before a change of settings. It may take the driver seconds, and
// is a call on the context like any other: one thread at a time. Where another thread records
// meanwhile, a second context with the same pipeline_cache can prepare, and be destroyed: the first
// then finds the pipelines in there.
//
// Errors: those of alcoveRecordFrame.
AlcoveResult alcovePrepareFrame(AlcoveContext* context, const AlcoveFrame* frame);

// Records the passes of all views into `commands`: a primary command buffer in recording, of the
// context's queue family, outside a render pass. Frames are submitted in the order in which they
// are recorded, each once and all to one queue; else alcoveDiscardFrame. A frame like the one
// before allocates nothing.
//
// Pipelines that it needs and that were not made before are made now, which may take the driver a
// second: see alcovePrepareFrame.
//
// It binds compute pipelines and descriptor set 0 and leaves them bound; other state is untouched.
// Barriers: each image from its initial_state to SHADER_READ_ONLY_OPTIMAL (inputs) or GENERAL
// (outputs), for compute shaders, before its first use; to its final_state after the last. In
// between only the library's own memory is concerned, but that a frame which differs from the one
// before begins with a full barrier. One image may serve as several inputs, described alike; an
// output serves as nothing else.
//
// Errors, with nothing recorded: a null pointer, a size of zero or over the largest, an enum's
// unknown value, a number out of range or that is not finite, a format or a usage that does not do,
// images that differ in size, a frame without a view, a view without an output.
AlcoveResult alcoveRecordFrame(AlcoveContext* context, VkCommandBuffer commands,
                               const AlcoveFrame* frame);

// Call this instead of submitting what was just recorded, before any other call on the context (the
// window closed, say). The context is then as if the frame had not been recorded, whatever its
// size, settings and outputs; otherwise the next frames would read histories that were never
// written. After a frame that failed, or none, there is nothing to do.
AlcoveResult alcoveDiscardFrame(AlcoveContext* context);

// Bytes of device memory of the frame recorded last; zeros before there is one, and after one that
// failed or was discarded. What transients share grows with the largest frame, and stays.
typedef struct AlcoveMemory {
  uint32_t struct_size;
  uint64_t transients;           // live during the frame, sharing memory
  uint64_t transients_unshared;  // what they were, were each given memory of its own
  uint64_t history;              // of all views
  uint64_t allocated;            // all that the context holds, parameters and tables too
} AlcoveMemory;

// Fills `memory`, whose struct_size is set.
AlcoveResult alcoveGetMemory(AlcoveContext* context, AlcoveMemory* memory);

// Outputs, to be combined.
typedef enum AlcoveOutput {
  ALCOVE_OUTPUT_VISIBILITY = 1,
  ALCOVE_OUTPUT_BENT_NORMAL = 2,
  ALCOVE_OUTPUT_SPECULAR = 4,
  ALCOVE_OUTPUT_MULTI_BOUNCE = 8,
  ALCOVE_OUTPUT_MAX_ENUM = 0x7fffffff
} AlcoveOutput;

// Fills `memory`, whose struct_size is set, with the bytes that one view of width x height pixels
// takes, before there is a context or a frame. `outputs` is a combination of AlcoveOutput;
// `normals_given` says that AlcoveView::normals has an image. The figures are those of texels:
// drivers round each image up. `transients` is what the view needs when nothing shares memory, as
// is `transients_unshared`; a frame that was recorded may need less. `allocated` is the sum of
// transients and history. ALCOVE_ERROR_INVALID_INPUT where an argument is invalid; there is no
// message.
AlcoveResult alcoveEstimateMemory(const AlcoveSettings* settings, uint32_t width, uint32_t height,
                                  uint32_t outputs, VkBool32 normals_given, AlcoveMemory* memory);

typedef struct AlcoveTiming {
  char pass[ALCOVE_MAX_NAME];
  uint32_t view;  // AlcoveView::id
  double milliseconds;
} AlcoveTiming;

// Device time of each pass, in order, of the frame last recorded with `slot`, once it has finished.
// `timings` null: *count becomes how many there are; else it says for how many there is room and
// becomes how many were written. None without timestamps.
AlcoveResult alcoveGetTimings(AlcoveContext* context, uint32_t slot, uint32_t* count,
                              AlcoveTiming* timings);

// The plan of the frame recorded last, for people: passes, barriers, memory. As alcovePrintSettings
// writes; 0 where there is no such frame, or no memory for its text.
size_t alcovePrintPlan(AlcoveContext* context, char* text, size_t size);

// Forgets a view and its history. The memory is freed in the next frames that are recorded, once
// the device has finished those that used it. An id that was never recorded is fine.
AlcoveResult alcoveDropView(AlcoveContext* context, uint32_t id);

// To be called before the engine destroys an image that it gave without a view: another may get the
// same handle. An image that was never given is fine.
AlcoveResult alcoveForgetImage(AlcoveContext* context, VkImage image);

#ifdef __cplusplus
}
#endif

#endif  // ALCOVE_ALCOVE_H_
