#ifndef ALCOVE_NORMALS_PARAMETERS_H
#define ALCOVE_NORMALS_PARAMETERS_H

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

struct NormalsParameters {
  vec4 slope;  // xy: ray_per_px(); zw: of the ray at the image's corner; view space
};

ALCOVE_MATHS_END

#endif
