#ifndef ALCOVE_LINE_DEPTH_PARAMETERS_H
#define ALCOVE_LINE_DEPTH_PARAMETERS_H

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

struct InverseDepthParameters {
  vec2 inverse_depth_from_ndc;  // line = x * depth_ndc + y
};

ALCOVE_MATHS_END

#endif
