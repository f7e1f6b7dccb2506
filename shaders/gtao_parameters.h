#ifndef ALCOVE_GTAO_PARAMETERS_H
#define ALCOVE_GTAO_PARAMETERS_H

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

struct GtaoParameters {
  // Areas for areas.h, read only with kAreas.
  ivec4 area;             // that is read: its position in the inputs (xy) and its size (zw)
  ivec4 written;          // the first tile that is traced (xy), and the last (zw)
  mat4 view_from_normal;  // rotation from the space of the normals to view space
  vec4 slope;             // xy: ray_per_px(); zw: of the ray at the image's corner; view space
  vec2 inverse_depth_from_ndc;  // scale and offset of inverse_depth_of_ndc()
  vec2 interleave_offset;       // the pixel of each tile that is traced in this frame
  float radius;                 // scene units
  uint frame;                   // number of the frame, which rotates the directions of the slices
  uint strip_groups;            // height of a strip of the image, in groups
  float thickness;              // of occluders, a fraction of the radius
  float hidden_exponent;        // of hidden_occlusion_behind()
  float roughness;  // perceptual, [0,1], of every surface if there is no roughness texture
  // The two members of DepthStep. A struct would be aligned differently in a uniform block and in
  // C++.
  float depth_step;
  float depth_step_per_inverse_depth;
};

ALCOVE_MATHS_END

#endif
