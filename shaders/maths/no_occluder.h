// The value for surfaces that do not occlude, in the depth buffer that is searched for occluders.
#ifndef ALCOVE_MATHS_NO_OCCLUDER_H
#define ALCOVE_MATHS_NO_OCCLUDER_H

#include "language.h"

ALCOVE_MATHS_BEGIN

// No raw depth has this value.
const float kNoOccluder = 2.0f;

ALCOVE_INLINE bool is_no_occluder(float depth_ndc) { return depth_ndc > 1.5f; }

ALCOVE_MATHS_END

#endif
