// The octahedral map, which encodes a unit vector in two numbers (Cigolle et al. 2014). It has no
// pole and no seam within a hemisphere, and its error is nearly uniform.
#ifndef ALCOVE_MATHS_OCTAHEDRAL_H
#define ALCOVE_MATHS_OCTAHEDRAL_H

#include "language.h"

ALCOVE_MATHS_BEGIN

// Returns the sign of x as 1 or -1; 0 gives 1.
ALCOVE_INLINE float sign_not_zero(float x) { return x < 0.0f ? -1.0f : 1.0f; }

// Maps a direction of any length except 0 to the square [-1,1]^2. The zero vector gives the same
// point as +Z.
ALCOVE_INLINE vec2 octahedral_encode(vec3 direction) {
  float length_1 = abs(direction.x) + abs(direction.y) + abs(direction.z);
  if (!(length_1 > 0.0f)) return vec2(0.0f, 0.0f);
  float x = direction.x / length_1;
  float y = direction.y / length_1;
  if (direction.z >= 0.0f) return vec2(x, y);
  return vec2((1.0f - abs(y)) * sign_not_zero(x), (1.0f - abs(x)) * sign_not_zero(y));
}

// Returns a vector in the direction of a point of the square [-1,1]^2. Its length is between
// sqrt(1/3) and 1.
ALCOVE_INLINE vec3 octahedral_unfold(vec2 encoded) {
  float z = 1.0f - abs(encoded.x) - abs(encoded.y);
  float fold = max(-z, 0.0f);  // in the square no larger than |x| and |y|
  return vec3(encoded.x - clamp(encoded.x, -fold, fold), encoded.y - clamp(encoded.y, -fold, fold),
              z);
}

// Returns the unit vector that a point of the square [-1,1]^2 encodes. Points outside the square
// also give a unit vector.
ALCOVE_INLINE vec3 octahedral_decode(vec2 encoded) { return normalize(octahedral_unfold(encoded)); }

ALCOVE_MATHS_END

#endif
