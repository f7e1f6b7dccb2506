#ifndef ALCOVE_UPSAMPLE_PARAMETERS_H
#define ALCOVE_UPSAMPLE_PARAMETERS_H

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

struct UpsampleParameters {
  // Areas for areas.h, read only with kAreas.
  ivec4 area;             // that is read: its position in the inputs (xy) and its size (zw)
  ivec4 written;          // the first pixel that is written (xy), and the last (zw)
  mat4 normal_from_view;  // rotation from view space to the space of the normals
  vec4 slope;             // xy: ray_per_px(); zw: of the ray at the image's corner; view space
  vec2 inverse_depth_from_ndc;  // of inverse_depth_of_ndc()
  vec2 pixel_uv;                // 1 over the size of the depth buffer
  vec2 texel_uv;                // 1 over the size of the half-resolution images
  vec2 half_pixel_per_tilt;     // change of inverse depth over half a pixel, per stored tilt
  ivec2 to_outputs;             // from pixels to the outputs
  float tolerance;              // scale of distances from the tangent plane, in depths
  float power;                  // of shaped_visibility()
  float intensity;              // of shaped_visibility()
};

ALCOVE_MATHS_END

#endif
