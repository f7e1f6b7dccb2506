#ifndef ALCOVE_MULTI_BOUNCE_PARAMETERS_H
#define ALCOVE_MULTI_BOUNCE_PARAMETERS_H

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

struct MultiBounceParameters {
  ivec4 positions;  // of the first pixel: xy in albedo_image, zw in the other images; with kAreas
  vec2 size_px;
};

ALCOVE_MATHS_END

#endif
