// A reconstructed texel of 2x2 pixels, from which upsampling makes pixels: its occlusion and the
// tangent plane of its surface, in 8 bytes.
#ifndef ALCOVE_MATHS_HALF_TEXEL_H
#define ALCOVE_MATHS_HALF_TEXEL_H

#include "language.h"

ALCOVE_MATHS_BEGIN

struct HalfTexel {
  float inverse_depth;  // of the plane at the texel's centre, at least 0, to 2^-14 of itself
  float occlusion;      // 1 - visibility, [0,1], to 2^-12; 0 and 1 are exact
  // The plane's slope: the view-space normal's xy over minus its component along the view ray that
  // has a depth of 1. Times ray_per_px(), and in perspective times -inverse_depth, it is the change
  // of inverse depth from one pixel to the next. Stored as halves.
  vec2 tilt;
};

// 21 bits of the depth's float, which has no sign, and 11 of the occlusion.
ALCOVE_INLINE uvec2 pack_half_texel(HalfTexel texel) {
  uint depth = ((floatBitsToUint(texel.inverse_depth) + 0x200u) << 1u) & 0xfffff800u;
  return uvec2(depth | uint(clamp(texel.occlusion, 0.0f, 1.0f) * 2047.0f + 0.5f),
               packHalf2x16(texel.tilt));
}

ALCOVE_INLINE float half_texel_inverse_depth(uint bits) {
  return uintBitsToFloat((bits & 0xfffff800u) >> 1u);
}

// In units of 1/2047.
ALCOVE_INLINE float half_texel_occlusion(uint bits) { return float(bits & 0x7ffu); }
const float kHalfTexelOcclusionUnit = 1.0f / 2047.0f;

ALCOVE_INLINE HalfTexel unpack_half_texel(uvec2 bits) {
  HalfTexel texel;
  texel.inverse_depth = half_texel_inverse_depth(bits.x);
  texel.occlusion = half_texel_occlusion(bits.x) * kHalfTexelOcclusionUnit;
  texel.tilt = unpackHalf2x16(bits.y);
  return texel;
}

ALCOVE_MATHS_END

#endif
