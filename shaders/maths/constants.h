// Numbers that more than one header needs.
#ifndef ALCOVE_MATHS_CONSTANTS_H
#define ALCOVE_MATHS_CONSTANTS_H

#include "language.h"

ALCOVE_MATHS_BEGIN

const float kPi = 3.14159265f;
const float kHalfPi = 1.57079633f;

// The linear depth of what is infinitely far. Its square still fits a float with room for sums.
const float kSkyDepth = 1e12f;

ALCOVE_MATHS_END

#endif
