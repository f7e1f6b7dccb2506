// An arc cosine with the same cost and error on every device, which acos() does not have.
#ifndef ALCOVE_MATHS_ARC_COSINE_H
#define ALCOVE_MATHS_ARC_COSINE_H

#include "constants.h"
#include "language.h"

ALCOVE_MATHS_BEGIN

// Returns acos(x) in radians with an error of at most 4.6e-5. x is clamped to [-1,1]. The result is
// sqrt(1 - |x|) times a cubic polynomial, mirrored for x < 0 and continuous at 0. The form is that
// of Abramowitz and Stegun 4.4.45. Of all coefficients with which the result is exact at 0, these
// have the smallest maximum error.
ALCOVE_INLINE float arc_cosine(float x) {
  float a = min(abs(x), 1.0f);
  float cubic = ((-0.0216414023f * a + 0.0779813800f) * a - 0.213301321f) * a + kHalfPi;
  float angle = sqrt(1.0f - a) * cubic;
  return x < 0.0f ? kPi - angle : angle;
}

ALCOVE_MATHS_END

#endif
