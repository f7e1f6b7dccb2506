#ifndef ALCOVE_APPLY_PARAMETERS_H
#define ALCOVE_APPLY_PARAMETERS_H

#include "maths/projection.h"

ALCOVE_MATHS_BEGIN

struct ApplyParameters {
  Projection projection;
  mat4 world_from_view;    // rotation
  mat4 world_from_normal;  // rotation from the space of the normals to world space
  vec2 map;                // of the environment: texels a side of its first level, levels
  float roughness;         // perceptual, where no texture has it
  float metallic;          // where no texture has it
};

ALCOVE_MATHS_END

#endif
