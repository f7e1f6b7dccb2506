#ifndef ALCOVE_APPLY_PARAMETERS_H
#define ALCOVE_APPLY_PARAMETERS_H

#include "maths/projection.h"

ALCOVE_MATHS_BEGIN

struct ApplyParameters {
  Projection projection;
  mat4 world_from_view;    // rotation
  mat4 world_from_normal;  // rotation from the space of the normals to world space
  vec2 map;                // the environment map: width of mip 0 in texels, number of mips
  float roughness;         // perceptual; used if there is no roughness texture
  float metallic;          // used if there is no metallic texture
};

ALCOVE_MATHS_END

#endif
