// Packs numbers in [0,1] in a few bits, rounded to the nearest value. 0 and 1 are exact.
#ifndef ALCOVE_MATHS_PACKING_H
#define ALCOVE_MATHS_PACKING_H

#include "language.h"

ALCOVE_MATHS_BEGIN

// Returns x, clamped to [0,1], as an integer of `bits` bits (1 to 16). unpack_unorm() then returns
// x with an error of at most 0.5 / (2^bits - 1).
ALCOVE_INLINE uint pack_unorm(float x, uint bits) {
  float last = float((1u << bits) - 1u);
  return uint(clamp(x, 0.0f, 1.0f) * last + 0.5f);
}

ALCOVE_INLINE float unpack_unorm(uint packed_bits, uint bits) {
  uint last = (1u << bits) - 1u;
  return float(packed_bits & last) / float(last);
}

ALCOVE_MATHS_END

#endif
