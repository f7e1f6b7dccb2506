// Constants that several headers need.
#ifndef ALCOVE_MATHS_CONSTANTS_H
#define ALCOVE_MATHS_CONSTANTS_H

#include "language.h"

ALCOVE_MATHS_BEGIN

const float kPi = 3.14159265f;
const float kHalfPi = 1.57079633f;

// The linear depth of the sky and of infinitely far surfaces, in scene units. It is small enough
// that a sum of several of its squares is still finite in a float.
const float kSkyDepth = 1e12f;

ALCOVE_MATHS_END

#endif
