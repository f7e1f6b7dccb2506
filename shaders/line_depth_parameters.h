#ifndef ALCOVE_LINE_DEPTH_PARAMETERS_H
#define ALCOVE_LINE_DEPTH_PARAMETERS_H

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

struct LineDepthParameters {
  vec2 line_from_ndc;  // line = x * depth_ndc + y
};

ALCOVE_MATHS_END

#endif
