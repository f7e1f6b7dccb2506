#ifndef ALCOVE_SURFACE_PARAMETERS_H
#define ALCOVE_SURFACE_PARAMETERS_H

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

struct SurfaceParameters {
  vec4 slope;  // xy: ray_per_px(); zw: of the ray at the image's corner; view space
  vec2 inverse_depth_from_ndc;  // of inverse_depth_of_ndc()
};

ALCOVE_MATHS_END

#endif
