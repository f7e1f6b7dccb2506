// Visibility and directions in few bits, rounded to nearest so that 0 and 1 are exact.
#ifndef ALCOVE_MATHS_PACKING_H
#define ALCOVE_MATHS_PACKING_H

#include "language.h"
#include "octahedral.h"

ALCOVE_MATHS_BEGIN

// x in [0,1] as an integer of `bits` bits (1 to 16). What lies outside is clamped; within
// 0.5 / (2^bits - 1) after unpack_unorm().
ALCOVE_INLINE uint pack_unorm(float x, uint bits) {
  float last = float((1u << bits) - 1u);
  return uint(clamp(x, 0.0f, 1.0f) * last + 0.5f);
}

ALCOVE_INLINE float unpack_unorm(uint packed_bits, uint bits) {
  uint last = (1u << bits) - 1u;
  return float(packed_bits & last) / float(last);
}

// A pair in 16 bits, 8 each.
ALCOVE_INLINE uint pack_unorm_pair(vec2 pair) {
  return pack_unorm(pair.x, 8u) | (pack_unorm(pair.y, 8u) << 8u);
}

ALCOVE_INLINE vec2 unpack_unorm_pair(uint packed_bits) {
  return vec2(unpack_unorm(packed_bits, 8u), unpack_unorm(packed_bits >> 8u, 8u));
}

// x in [0,1] rounded to one of 256 levels up or down by `dither` in [0,1), so that the mean over
// dithers is x. 0 and 1 stay themselves.
ALCOVE_INLINE float dither_unorm8(float x, float dither) {
  return min(floor(clamp(x, 0.0f, 1.0f) * 255.0f + dither), 255.0f) / 255.0f;
}

// Visibility (8 bits) and bent normal (two octahedral components of 12) in 32 bits: within 1/510,
// and within 0.06 degrees.
ALCOVE_INLINE uint pack_occlusion(float visibility, vec3 bent_normal) {
  vec2 square = octahedral_encode(bent_normal);
  return pack_unorm(visibility, 8u) | (pack_unorm(square.x * 0.5f + 0.5f, 12u) << 8u) |
         (pack_unorm(square.y * 0.5f + 0.5f, 12u) << 20u);
}

ALCOVE_INLINE float unpack_occlusion_visibility(uint packed_bits) {
  return unpack_unorm(packed_bits, 8u);
}

ALCOVE_INLINE vec3 unpack_occlusion_bent_normal(uint packed_bits) {
  float x = unpack_unorm(packed_bits >> 8u, 12u);
  float y = unpack_unorm(packed_bits >> 20u, 12u);
  return octahedral_decode(vec2(x * 2.0f - 1.0f, y * 2.0f - 1.0f));
}

ALCOVE_MATHS_END

#endif
