// Cameras, helpers that make them from an engine's matrices or numbers, and the areas of images
// that cameras describe. Included by alcove.h.
#ifndef ALCOVE_ALCOVE_CAMERA_H_
#define ALCOVE_ALCOVE_CAMERA_H_

#include <stdint.h>

#include "alcove/alcove_result.h"

#ifdef __cplusplus
extern "C" {
#endif

// The camera that the depth buffer was drawn with, including its jitter. alcoveConvertCamera
// computes it from the matrices of other conventions. To convert matrices yourself: if the viewport
// has a negative height, change the sign of the second row of clip_from_view. If the camera looks
// along +Z of view space, change the sign of the third column of clip_from_view, of the third row
// of view_from_world, and of z of normals in view space.
//
// Rounding errors of matrix products and inverses are accepted: elements that should be exactly 0
// or 1 may deviate by that much, and the library corrects them.
typedef struct AlcoveCamera {
  // The projection: finite, infinite, reversed, off-centre, jittered, flipped in Y, or
  // orthographic. In a perspective projection, the clip-space w must be 0 at the eye.
  float clip_from_view[16];
  // The matrix from world to view space: a rotation and a translation, without scale, or, for
  // left-handed worlds, a reflection and a translation.
  float view_from_world[16];
} AlcoveCamera;

// A rectangle of pixels. x and y are the position of its upper left pixel.
typedef struct AlcoveArea {
  uint32_t x;
  uint32_t y;
  uint32_t width;
  uint32_t height;
} AlcoveArea;

// Bits that say how an engine's matrices differ from those of AlcoveCamera. They can be combined,
// and are an argument of alcoveConvertCamera.
typedef enum AlcoveCameraConvention {
  // Clip-space y points up: the viewport has a negative height, or the API defines it so.
  ALCOVE_CAMERA_CONVENTION_CLIP_Y_UP = 1,
  // Clip-space depth runs from -1 to 1, and the depth buffer holds 0.5 + 0.5 * depth.
  ALCOVE_CAMERA_CONVENTION_DEPTH_FROM_MINUS_ONE = 2,
  // The camera looks along +Z of view space.
  ALCOVE_CAMERA_CONVENTION_FORWARD_Z = 4,
  // The matrices transform column vectors and are stored row by row. DirectXMath and Unreal store
  // matrices row by row too, but theirs transform row vectors; in memory these equal matrices of
  // column vectors that are stored column by column, so they do not need this bit.
  ALCOVE_CAMERA_CONVENTION_ROW_MAJOR = 8,

  // The matrices of glm::perspectiveRH_ZO and glm::lookAtRH, drawn with a viewport of negative
  // height. Engines that instead change the sign of the projection's element [1][1] need no
  // conversion.
  ALCOVE_CAMERA_CONVENTION_GLM = 1,
  // The matrices of gluPerspective and glFrustum.
  ALCOVE_CAMERA_CONVENTION_OPENGL = 3,
  // Direct3D, DirectXMath's ...LH functions and Unreal's view and projection matrices.
  ALCOVE_CAMERA_CONVENTION_DIRECT3D = 5,
  ALCOVE_CAMERA_CONVENTION_UNREAL = 5,
  ALCOVE_CAMERA_CONVENTION_MAX_ENUM = 0x7fffffff
} AlcoveCameraConvention;

// Fills `camera` with an engine's matrices of 16 floats each. `conventions` is any combination of
// AlcoveCameraConvention, 0 for none. Returns ALCOVE_ERROR_INVALID_INPUT if a pointer is null or a
// bit is unknown. The values of the matrices are checked when a frame is recorded. If the camera
// looks along +Z and normals are in view space, set AlcoveViewInfo::normals_forward_z too.
AlcoveResult alcoveConvertCamera(const float* clip_from_view, const float* view_from_world,
                                 uint32_t conventions, AlcoveCamera* camera);

// The numbers from which alcoveMakePerspective makes a projection.
typedef struct AlcovePerspective {
  uint32_t struct_size;
  float fov_y;        // vertical angle of view in radians, above 0 and below pi
  float near_plane;   // distance in scene units, above 0
  float far_plane;    // above near_plane; 0 or infinity: infinite
  uint32_t reversed;  // 1: near at depth 1, far at depth 0
  uint32_t width;     // of the image in pixels
  uint32_t height;
  float jitter_px[2];  // the shift of the image in pixels, x to the right and y down
} AlcovePerspective;

// Fills the 16 floats of AlcoveCamera::clip_from_view. Returns ALCOVE_ERROR_INVALID_INPUT if a
// number is out of range.
AlcoveResult alcoveMakePerspective(const AlcovePerspective* perspective, float* clip_from_view);

#ifdef __cplusplus
}
#endif

#endif  // ALCOVE_ALCOVE_CAMERA_H_
