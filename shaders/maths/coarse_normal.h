// A normal in a byte: enough to tell the faces at a crease apart.
#ifndef ALCOVE_MATHS_COARSE_NORMAL_H
#define ALCOVE_MATHS_COARSE_NORMAL_H

#include "octahedral.h"

ALCOVE_MATHS_BEGIN

// Of any length but 0, in any space. Each octahedral coordinate is one of 15, as many on each side of
// 0: axes are exact, and a mirrored normal is the mirrored one's byte.
ALCOVE_INLINE uint pack_coarse_normal(vec3 normal) {
  vec2 encoded = octahedral_encode(normal);
  return uint(encoded.x * 7.0f + 7.5f) | (uint(encoded.y * 7.0f + 7.5f) << 4u);
}

// Unit, within 17 degrees of what was packed. Bits above the lowest eight do not matter.
ALCOVE_INLINE vec3 unpack_coarse_normal(uint bits) {
  return octahedral_decode(vec2((float(bits & 15u) - 7.0f) * (1.0f / 7.0f),
                                (float((bits >> 4u) & 15u) - 7.0f) * (1.0f / 7.0f)));
}

ALCOVE_MATHS_END

#endif
