#ifndef ALCOVE_GTAO_PARAMETERS_H
#define ALCOVE_GTAO_PARAMETERS_H

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

struct GtaoParameters {
  mat4 view_from_normal;  // rotation from the space of the normals to view space
  vec4 slope;             // xy: ray_per_px(); zw: of the ray at the image's corner; view space
  vec2 phase;             // which pixel of a block is searched
  float radius;           // scene units
  uint frame;             // turns the noise
  float thickness;        // of what is joined to nothing, scene units (bitmask)
  float fill;             // share of what lies behind an occluder that counts as occluded, [0,1]
  float roughness;        // perceptual, of every surface where no texture has it
};

ALCOVE_MATHS_END

#endif
