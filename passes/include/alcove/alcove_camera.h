// Cameras, and helpers that make them from an engine's matrices or numbers. Included by alcove.h.
#ifndef ALCOVE_ALCOVE_CAMERA_H_
#define ALCOVE_ALCOVE_CAMERA_H_

#include "alcove/alcove_result.h"

#ifdef __cplusplus
extern "C" {
#endif

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

// How an engine's matrices differ from those of AlcoveCamera, for alcoveConvertCamera. Bits to be
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
// AlcoveCameraConvention, 0 for none. Returns ALCOVE_ERROR_INVALID_INPUT if a pointer is null or a
// bit is unknown; what the matrices hold is checked when a frame is recorded. Normals in view space
// of a camera that looks along +Z need AlcoveView::normals_forward_z too.
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

// Fills AlcoveCamera::clip_from_view. Returns ALCOVE_ERROR_INVALID_INPUT if a number is out of
// range.
AlcoveResult alcoveMakePerspective(const AlcovePerspective* perspective, float* clip_from_view);

#ifdef __cplusplus
}
#endif

#endif  // ALCOVE_ALCOVE_CAMERA_H_
