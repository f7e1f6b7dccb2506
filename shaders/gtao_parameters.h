#ifndef ALCOVE_GTAO_PARAMETERS_H
#define ALCOVE_GTAO_PARAMETERS_H

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

struct GtaoParameters {
  mat4 view_from_normal;  // rotation from the space of the normals to view space
  vec4 slope;             // xy: ray_per_px(); zw: of the ray at the image's corner; view space
  vec2 inverse_depth_from_ndc;  // of inverse_depth_of_ndc()
  vec2 interleave_offset;       // which pixel of a block is searched
  float radius;                 // scene units
  uint frame;                   // turns the noise
  float thickness;              // of an occluder, scene units or parts of its distance from the eye
  float hidden_exponent;        // of hidden_occlusion_behind()
  float blend;                  // of a horizon towards each lower sample, [0,1] (heuristic)
  float falloff;    // last part of the radius, over which occluders fade, [0,1] (horizons and
                    // heuristic)
  float roughness;  // perceptual, of every surface where no texture has it
  // DepthStep, whose alignment in a uniform block would differ from C++.
  float depth_step;
  float depth_step_per_inverse_depth;
};

ALCOVE_MATHS_END

#endif
