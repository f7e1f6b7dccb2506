// The work of a view as data, for engines that schedule compute passes themselves: with a render
// graph of their own, or on another API than Vulkan. alcoveDescribeWork turns settings, cameras,
// sizes and formats into a list of resources and dispatches. It is a pure function: it needs no
// context and no device, keeps no state, and allocates memory only if it fails. This header needs
// no header of Vulkan. passes/ENGINES.md shows how engines execute the list.
//
//   Each frame: alcoveDescribeWork with the list of the last frame that was executed.
//               For each transient, a texture that is used from first_dispatch to last_dispatch.
//               For each history, the texture that was its current slot in the last frame is bound
//               as its previous slot, and another texture as its current slot.
//               For each dispatch, in order: a barrier for what its bindings read and write, the
//               pipeline of its shader and constants, its bindings, its parameters, its groups.
#ifndef ALCOVE_ALCOVE_WORK_H_
#define ALCOVE_ALCOVE_WORK_H_

#include "alcove/alcove_result.h"
#include "alcove/alcove_view.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ALCOVE_MAX_WORK_RESOURCES 40
#define ALCOVE_MAX_WORK_DISPATCHES 24
#define ALCOVE_MAX_WORK_BINDINGS 17          // of a dispatch
#define ALCOVE_MAX_WORK_CONSTANTS 24         // of a dispatch
#define ALCOVE_MAX_WORK_PARAMETER_BYTES 512  // of a dispatch
#define ALCOVE_MAX_WORK_HISTORIES 4
#define ALCOVE_WORK_NONE 0xffffffffu  // no resource, or no dispatch

// The formats of the resources that the passes create, which have the numbers of VkFormat:
//
//     9 R8_UNORM              38 R8G8B8A8_SNORM        83 R16G16_SFLOAT
//    37 R8G8B8A8_UNORM        64 A2B10G10R10_UNORM     97 R16G16B16A16_SFLOAT
//    74 R16_UINT              92 R16G16B16A16_SNORM   100 R32_SFLOAT
//    76 R16_SFLOAT           101 R32G32_UINT          107 R32G32B32A32_UINT
//    77 R16G16_UNORM                                  109 R32G32B32A32_SFLOAT
//
// Depth buffers are D16_UNORM (124), X8_D24_UNORM (125), D32_SFLOAT (126), D24_UNORM_S8_UINT (129)
// or D32_SFLOAT_S8_UINT (130). Images of the engine may have any format that AlcoveImageRole
// allows.

typedef enum AlcoveResourceKind {
  ALCOVE_RESOURCE_KIND_INPUT = 0,      // an image of the engine that is read
  ALCOVE_RESOURCE_KIND_OUTPUT = 1,     // an image of the engine that is written
  ALCOVE_RESOURCE_KIND_TRANSIENT = 2,  // contents are not needed before or after its lifetime
  ALCOVE_RESOURCE_KIND_HISTORY_PREVIOUS = 3,  // written in the last frame; see AlcoveWorkHistory
  ALCOVE_RESOURCE_KIND_HISTORY_CURRENT = 4,   // written in this frame and kept for the next one
  ALCOVE_RESOURCE_KIND_TABLE = 5,             // a storage buffer with the bytes of `data`
  ALCOVE_RESOURCE_KIND_MAX_ENUM = 0x7fffffff
} AlcoveResourceKind;

typedef enum AlcoveBindingType {
  ALCOVE_BINDING_TYPE_PARAMETERS = 0,     // a uniform buffer with AlcoveWorkDispatch::parameters
  ALCOVE_BINDING_TYPE_TABLE = 1,          // a storage buffer that is only read
  ALCOVE_BINDING_TYPE_SAMPLER = 2,        // nearest, clamped to the edge, no mips; for gathers
  ALCOVE_BINDING_TYPE_FETCHED_IMAGE = 3,  // only read; a texture without a sampler of its own
  ALCOVE_BINDING_TYPE_STORAGE_IMAGE = 4,
  ALCOVE_BINDING_TYPE_MAX_ENUM = 0x7fffffff
} AlcoveBindingType;

// Bits.
typedef enum AlcoveWorkAccess {
  ALCOVE_WORK_ACCESS_READ = 1,
  ALCOVE_WORK_ACCESS_WRITE = 2,
  ALCOVE_WORK_ACCESS_MAX_ENUM = 0x7fffffff
} AlcoveWorkAccess;

// How an image is used in the frame, as bits.
typedef enum AlcoveWorkUsage {
  ALCOVE_WORK_USAGE_SAMPLED = 1,
  ALCOVE_WORK_USAGE_STORAGE = 2,
  ALCOVE_WORK_USAGE_MAX_ENUM = 0x7fffffff
} AlcoveWorkUsage;

// Every image has one mip and one layer.
typedef struct AlcoveWorkResource {
  const char* name;  // static; histories have the same name in both slots
  AlcoveResourceKind kind;
  uint32_t role;    // of an input or output: its AlcoveImageRole; else ALCOVE_WORK_NONE
  uint32_t format;  // the number of its VkFormat; 0 for a table
  uint32_t width;   // in texels
  uint32_t height;
  uint32_t samples;  // per pixel: 1, except for depth of the engine; 0 for a table
  uint32_t usage;    // a combination of AlcoveWorkUsage
  // The indices of the first and the last dispatch that bind the resource. Transients whose ranges
  // do not overlap may share memory. Both are ALCOVE_WORK_NONE if no dispatch binds it.
  uint32_t first_dispatch;
  uint32_t last_dispatch;
  uint64_t size;  // in bytes: of a table, or of the texels of an image; 0 for the engine's images
  const void* data;  // static; null for images
} AlcoveWorkResource;

// Every binding of an image needs a resource. If the constants switch off the only use of a binding
// that is read, it gets another image that the dispatch reads. If they switch off the only use of
// one that is written, it gets a transient of one texel. An image that a dispatch writes is
// therefore never bound twice.
typedef struct AlcoveWorkBinding {
  const char* name;  // of the variable in the shader; empty for PARAMETERS and TABLE
  uint32_t number;   // layout(binding = number), set 0
  AlcoveBindingType type;
  uint32_t access;    // a combination of AlcoveWorkAccess, as the shader declares it
  uint32_t resource;  // index of the resource; ALCOVE_WORK_NONE for PARAMETERS and SAMPLER
} AlcoveWorkBinding;

typedef struct AlcoveWorkConstant {
  uint32_t id;     // layout(constant_id = id)
  uint32_t value;  // of a bool: 0 or 1
} AlcoveWorkConstant;

// A compute dispatch. Between two dispatches that access the same resource, of which one writes it,
// there must be a barrier. Two bindings of one dispatch may have the same image if both only read
// it.
typedef struct AlcoveWorkDispatch {
  const char* label;   // static, such as "gtao"
  const char* shader;  // static: the name for alcoveGetShader and of the file of the shader
  uint32_t groups[3];
  uint32_t constant_count;
  uint32_t binding_count;
  uint32_t parameter_bytes;
  // All specialisation constants of the shader, ascending by id.
  AlcoveWorkConstant constants[ALCOVE_MAX_WORK_CONSTANTS];
  // All bindings of the shader, ascending by number.
  AlcoveWorkBinding bindings[ALCOVE_MAX_WORK_BINDINGS];
  unsigned char parameters[ALCOVE_MAX_WORK_PARAMETER_BYTES];
} AlcoveWorkDispatch;

// A texture that is kept from frame to frame, in two slots. The current slot of this frame is the
// previous slot of the next one, so that each texture needs the usages of both slots.
typedef struct AlcoveWorkHistory {
  uint32_t previous;  // index of the resource; its contents are not read if history_valid is 0
  uint32_t current;
} AlcoveWorkHistory;

// The work of one view in one frame, 30 KiB: too large for small stacks. Elements beyond the counts
// are undefined.
typedef struct AlcoveWork {
  AlcoveCamera camera;  // of AlcoveWorkInfo
  uint32_t width;       // of the depth image, or of the area that is read
  uint32_t height;
  // Whether the previous slots of the histories are read. If not, the histories begin again.
  uint32_t history_valid;
  uint32_t resource_count;
  uint32_t dispatch_count;
  uint32_t history_count;
  AlcoveWorkHistory histories[ALCOVE_MAX_WORK_HISTORIES];
  AlcoveWorkResource resources[ALCOVE_MAX_WORK_RESOURCES];
  AlcoveWorkDispatch dispatches[ALCOVE_MAX_WORK_DISPATCHES];
} AlcoveWork;

// An image of the engine. A format of 0 means that there is no image.
typedef struct AlcoveWorkImage {
  uint32_t format;  // the number of its VkFormat
  uint32_t width;   // in pixels
  uint32_t height;
  uint32_t samples;  // per pixel; 0 means 1
} AlcoveWorkImage;

// Everything that the work of a view depends on.
typedef struct AlcoveWorkInfo {
  uint32_t struct_size;
  // The view. Its id is not read. Its previous camera and size are those of `previous`.
  AlcoveViewInfo view;
  // The list of the last frame of this view that was executed, whose histories were kept, or null:
  // in the first frame, and if the histories were dropped. Its camera, its size and its histories
  // are read.
  const AlcoveWork* previous;
  uint32_t index;                              // the number of the frame, as AlcoveFrame::index
  AlcoveWorkImage images[ALCOVE_IMAGE_COUNT];  // by AlcoveImageRole
} AlcoveWorkInfo;

// Fills `work` with the work of a view. `work` may be info->previous, which is read first. If
// `message` is not null, it must have room for ALCOVE_MAX_MESSAGE bytes, and receives the sentence
// of the error. Errors: those of alcoveRecordFrame that concern settings, cameras, sizes and
// formats.
AlcoveResult alcoveDescribeWork(const AlcoveWorkInfo* info, AlcoveWork* work, char* message);

// A pipeline that work needs: a shader and the values of all of its specialisation constants.
typedef struct AlcoveWorkPipeline {
  const char* shader;  // as in AlcoveWorkDispatch
  uint32_t constant_count;
  AlcoveWorkConstant constants[ALCOVE_MAX_WORK_CONSTANTS];
} AlcoveWorkPipeline;

// Fills `pipelines` with all pipelines that frames of a view with these settings, images and areas
// and this kind of projection (perspective or not, reversed or not, with a finite far plane or not)
// can need: a first frame, frames in motion, static and converged ones. `previous`, `index`,
// cameras of earlier frames and the static_frames of the view make no difference. If `pipelines` is
// null, *count becomes their number, at most ALCOVE_MAX_WORK_PIPELINES. Otherwise *count is the
// number that `pipelines` has room for, and becomes the number written. Errors and `message` are as
// for alcoveDescribeWork.
#define ALCOVE_MAX_WORK_PIPELINES 16
AlcoveResult alcoveListPipelines(const AlcoveWorkInfo* info, uint32_t* count,
                                 AlcoveWorkPipeline* pipelines, char* message);

// Writes a list as text that people can read. Writes and returns as alcovePrintSettings does.
size_t alcovePrintWork(const AlcoveWork* work, char* text, size_t size);

// A compute shader of the library, with groups of 8x8 invocations and the entry point "main".
typedef struct AlcoveShader {
  const uint32_t* code;  // static: the words of a SPIR-V 1.3 module
  size_t code_size;      // in bytes
} AlcoveShader;

// Fills `shader` with the SPIR-V of a shader, by the name that AlcoveWorkDispatch::shader has.
// `cmake --install` also writes it to share/alcove/shaders, with its debug names and with the
// interfaces of all shaders.
AlcoveResult alcoveGetShader(const char* name, AlcoveShader* shader);

#ifdef __cplusplus
}
#endif

#endif  // ALCOVE_ALCOVE_WORK_H_
