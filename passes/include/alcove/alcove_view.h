// The description of a view without the images themselves: its camera, areas and conventions, and
// the roles of its images. Included by alcove.h and alcove_work.h. It needs no header of Vulkan.
#ifndef ALCOVE_ALCOVE_VIEW_H_
#define ALCOVE_ALCOVE_VIEW_H_

#include "alcove/alcove_camera.h"
#include "alcove/alcove_settings.h"

#ifdef __cplusplus
extern "C" {
#endif

// The images of a view, by the index in its array of images. Only DEPTH and one output are
// required; an output without an image is not computed, and costs no pass and no memory.
typedef enum AlcoveImageRole {
  // Inputs, which must all have the same size.
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
  ALCOVE_IMAGE_DEPTH = 0,
  // The unit normals of the surfaces, encoded as normal_encoding says. Without an image, normals
  // are computed from depth, and bent normals are in view space.
  //
  // A normal that faces away from the eye by more than 14 degrees is flipped, so that double-sided
  // surfaces may have either sign. A normal that faces away by less is either flipped or rotated
  // until it is perpendicular to the view direction; the normal from depth decides which. A normal
  // that is zero or not finite is replaced by the normal from depth.
  ALCOVE_IMAGE_NORMALS = 1,
  // Motion vectors: how far each surface moved on the image, in x and y of a signed format. Without
  // an image, only the camera is assumed to move. With an image, occluders may move too, and the
  // history is replaced where it differs from the last few frames. Leave the image out if nothing
  // but the camera moves. See AlcoveViewInfo::motion_scale.
  ALCOVE_IMAGE_MOTION = 2,
  ALCOVE_IMAGE_ROUGHNESS = 3,  // perceptual, [0,1]; without an image, AlcoveSettings::roughness
  // The depth of the nearest back faces: the scene drawn like DEPTH, but with front faces culled.
  // Required with ALCOVE_THICKNESS_LIMIT_BACK_FACES, and not read otherwise.
  ALCOVE_IMAGE_BACK_DEPTH = 4,
  // The second depth layer: the scene drawn like DEPTH, but with back faces culled and without the
  // fragments that are not behind DEPTH by at least a thousandth of their distance. Required if
  // depth_layers is 2, and not read otherwise.
  ALCOVE_IMAGE_SECOND_DEPTH = 5,
  ALCOVE_IMAGE_ALBEDO = 6,  // linear RGB, [0,1], for MULTI_BOUNCE
  // A mask of surfaces, R8_UNORM or R8_UINT, for example for emissive or unlit surfaces, for water
  // that is drawn into depth, and for weapons in the hand of the player. Without an image there is
  // no mask. With one, a pass copies depth twice, which takes 8 bytes per pixel of transient
  // memory. See AlcoveViewInfo::not_receiving.
  ALCOVE_IMAGE_MASK = 7,

  // Outputs, in any format with enough channels that the device can store to. They have the size of
  // the inputs, except with areas (AlcoveViewInfo::read_area). The sky (pixels whose depth is at
  // the far plane or is NaN) gets the visibility 1, and its bent normal is the normal.
  ALCOVE_IMAGE_VISIBILITY = 8,  // one channel, [0,1], 1 is open; R8_UNORM is enough
  // The mean visible direction: a unit vector in the space of the normals, in three signed
  // channels. R8G8B8A8_SNORM is enough.
  ALCOVE_IMAGE_BENT_NORMAL = 9,
  ALCOVE_IMAGE_SPECULAR = 10,  // one channel, [0,1]: multiplies specular probe light
  // Three channels, [0,1]: visibility with light reflected by occluders.
  ALCOVE_IMAGE_MULTI_BOUNCE = 11,
  ALCOVE_IMAGE_MAX_ENUM = 0x7fffffff
} AlcoveImageRole;
#define ALCOVE_IMAGE_COUNT 12
#define ALCOVE_IMAGE_FIRST_OUTPUT 8

// How the image NORMALS holds normals. The decoded vectors may have any length but 0.
typedef enum AlcoveNormalEncoding {
  // xyz in a signed or float format of at least 3 channels.
  ALCOVE_NORMAL_ENCODING_SIGNED_XYZ = 0,
  // The components x, y and z packed into [0,1] as 0.5 + 0.5 * normal, in any format of at least 3
  // channels, such as A2B10G10R10_UNORM or R8G8B8A8_UNORM.
  ALCOVE_NORMAL_ENCODING_UNSIGNED_XYZ = 1,
  // The octahedral map (Cigolle et al. 2014) in xy of a signed or float format.
  ALCOVE_NORMAL_ENCODING_OCTAHEDRAL = 2,
  // The octahedral map packed into [0,1], in any format of at least 2 channels.
  ALCOVE_NORMAL_ENCODING_UNSIGNED_OCTAHEDRAL = 3,
  ALCOVE_NORMAL_ENCODING_MAX_ENUM = 0x7fffffff
} AlcoveNormalEncoding;

// A view of a frame, such as an eye or a part of a split screen, without its images.
typedef struct AlcoveViewInfo {
  // The number that identifies the view, different from those of the frame's other views. Each id
  // has its own history.
  uint32_t id;
  // Whether the view begins a new history, for example after a camera cut. A change of size begins
  // a new history in any case, unless the size stays within largest_width and largest_height.
  uint32_t reset_history;
  // The number of consecutive frames, up to and including this one, whose image is exactly that of
  // the frame before. It is 0 if this frame differs from the previous one, or if the engine does
  // not know. It must start again at 0 after reset_history and when the size, the settings or the
  // outputs change. If it is at least 1, MOTION is not read. If it is at least 16, the history
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

  // The number of the VkFormat in which depths were first stored, if DEPTH is a copy in another
  // format. 0 means the format of DEPTH. [0]
  uint32_t depth_format;
  AlcoveNormalEncoding normal_encoding;
  uint32_t normals_in_view_space;  // 0: in world space
  // Whether normals in view space have a z axis that points away from the eye, as in engines whose
  // camera looks along +Z. Bent normals are then written with the same axis.
  uint32_t normals_forward_z;
  // motion_scale * vector + motion_offset must be the uv of a surface in this frame's image minus
  // its uv in the previous frame's image, with y down and with the jitter of both cameras. The
  // scale is 1 / size for vectors in pixels, 0.5 for vectors in normalised device coordinates (with
  // Vulkan's y down), and negative for vectors that point from this frame to the previous one. A
  // scale of zeros means 1 and 1. If the vectors were drawn without jitter, the offset is this
  // frame's jitter minus the previous frame's, in uv.
  float motion_scale[2];
  float motion_offset[2];
  // Surfaces whose MASK has one of these bits do not receive occlusion: their visibility and
  // specular occlusion are 1, and their bent normal is the normal (without NORMALS, the direction
  // to the eye). The filter and the history do not mix them with other surfaces.
  uint32_t not_receiving;
  // Surfaces with one of these bits do not occlude. Depth does not tell what lies behind them;
  // these directions count as unobserved, like those behind a distant foreground.
  uint32_t not_occluding;
} AlcoveViewInfo;

#ifdef __cplusplus
}
#endif

#endif  // ALCOVE_ALCOVE_VIEW_H_
