#ifndef ALCOVE_GTSO_PARAMETERS_H
#define ALCOVE_GTSO_PARAMETERS_H

#include "maths/projection.h"

ALCOVE_MATHS_BEGIN

struct GtsoParameters {
  Projection projection;
  mat4 view_from_normal;  // rotation from the space of the normals to view space
  float roughness;        // perceptual; used if there is no roughness texture
};

ALCOVE_MATHS_END

#endif
