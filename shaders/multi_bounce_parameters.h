#ifndef ALCOVE_MULTI_BOUNCE_PARAMETERS_H
#define ALCOVE_MULTI_BOUNCE_PARAMETERS_H

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

struct MultiBounceParameters {
  vec2 size_px;
};

ALCOVE_MATHS_END

#endif
