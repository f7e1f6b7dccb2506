// A reconstructed texel of 2x2 pixels, which upsampling turns into pixels: its occlusion and the
// tangent plane of its surface, in 8 bytes.
#ifndef ALCOVE_MATHS_HALF_TEXEL_H
#define ALCOVE_MATHS_HALF_TEXEL_H

#include "language.h"

ALCOVE_MATHS_BEGIN

struct HalfTexel {
  float inverse_depth;  // of the plane at the texel's centre, at least 0; relative error 2^-14
  float occlusion;      // 1 - visibility, [0,1]; error 2^-12; 0 and 1 are exact
  // The plane's slope: the xy components of the view-space normal, divided by minus its component
  // along the view ray with depth 1. Multiplied by ray_per_px(), and in perspective by
  // -inverse_depth, it is the change of inverse depth from one pixel to the next. It is stored as
  // half floats.
  vec2 tilt;
};

// Packs a texel: 21 bits of the depth's float, which has no sign, 11 bits of the occlusion, and two
// half floats.
ALCOVE_INLINE uvec2 pack_half_texel(HalfTexel texel) {
  uint depth = ((floatBitsToUint(texel.inverse_depth) + 0x200u) << 1u) & 0xfffff800u;
  return uvec2(depth | uint(clamp(texel.occlusion, 0.0f, 1.0f) * 2047.0f + 0.5f),
               packHalf2x16(texel.tilt));
}

ALCOVE_INLINE float half_texel_inverse_depth(uint bits) {
  return uintBitsToFloat((bits & 0xfffff800u) >> 1u);
}

// Returns the occlusion, which is stored in units of 1/2047.
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
