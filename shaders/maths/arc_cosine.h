// acos without the device's own, whose cost and error differ from driver to driver.
#ifndef ALCOVE_MATHS_ARC_COSINE_H
#define ALCOVE_MATHS_ARC_COSINE_H

#include "constants.h"
#include "language.h"

ALCOVE_MATHS_BEGIN

// acos(x) within 4.6e-5 rad: sqrt(1 - |x|) times a cubic, mirrored for x < 0, without a step at 0.
// x outside [-1,1] is taken as the nearer end. (The form of Abramowitz and Stegun 4.4.45; the
// coefficients are the least maximum error among those exact at 0.)
ALCOVE_INLINE float arc_cosine(float x) {
  float a = min(abs(x), 1.0f);
  float cubic = ((-0.0216414023f * a + 0.0779813800f) * a - 0.213301321f) * a + kHalfPi;
  float angle = sqrt(1.0f - a) * cubic;
  return x < 0.0f ? kPi - angle : angle;
}

ALCOVE_MATHS_END

#endif
