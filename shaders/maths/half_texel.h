// A reconstructed texel of 2x2 pixels, from which upsampling makes pixels: its occlusion and the
// tangent plane of its surface. The next frame reads it as history. It is stored in two images of
// formats that texture units unpack: R16G16B16A16_SNORM and R32_SFLOAT.
#ifndef ALCOVE_MATHS_HALF_TEXEL_H
#define ALCOVE_MATHS_HALF_TEXEL_H

#include "language.h"
#include "raw_occlusion.h"

ALCOVE_MATHS_BEGIN

// Largest component of a tilt, 86 degrees; larger ones are stored as this.
const float kLargestTilt = 16.0f;

// Weights are stored in units of so many frames.
const float kHalfTexelWeightUnit = 128.0f;

struct HalfTexel {
  float occlusion;  // 1 - visibility, [0,1], to 2^-16; 0 and 1 are exact
  float weight;     // of the history, frames, [0,kMaxHistoryFrames]
  // The plane's slope: the view-space normal's xy over minus its component along the view ray that
  // has a depth of 1. Times ray_per_px(), and in perspective times -inverse_depth, it is the change
  // of inverse depth from one pixel to the next.
  vec2 tilt;
};

ALCOVE_INLINE vec4 pack_half_texel(HalfTexel texel) {
  return vec4(texel.occlusion, texel.weight * (1.0f / kHalfTexelWeightUnit),
              texel.tilt.x * (1.0f / kLargestTilt), texel.tilt.y * (1.0f / kLargestTilt));
}

// The inverse depth of the plane at the texel's centre, at least 0, as R32_SFLOAT. The last eight
// bits of its mantissa hold the occlusion of the last few frames where `knows_recent`, so the depth
// is exact to 2^-15 of itself.
ALCOVE_INLINE float half_texel_depth(float inverse_depth, float recent, bool knows_recent) {
  uint bits = floatBitsToUint(inverse_depth) & 0xffffff00u;
  uint code = knows_recent ? uint(sqrt(clamp(recent, 0.0f, 1.0f)) * 254.0f + 1.5f) : 0u;
  return uintBitsToFloat(bits | code);
}

// The occlusion of the last few frames, by its root, or `otherwise` where it is not known.
ALCOVE_INLINE float half_texel_recent(float depth, float otherwise) {
  uint code = floatBitsToUint(depth) & 255u;
  float root = (float(code) - 1.0f) * (1.0f / 254.0f);
  return code == 0u ? otherwise : root * root;
}

// A bent-normal residual (bent_normal.h) as A2B10G10R10_UNORM, so that 0 is exact. `dither` in
// [0,1) replaces the 0.5 of rounding to nearest.
ALCOVE_INLINE vec4 pack_half_residual(vec3 residual, float dither) {
  float scale = 511.0f / (1023.0f * kLargestResidual);
  float offset = (511.5f + dither) * (1.0f / 1023.0f);
  return vec4(residual.x * scale + offset, residual.y * scale + offset, residual.z * scale + offset,
              0.0f);
}

ALCOVE_INLINE vec3 unpack_half_residual(vec3 stored) {
  return (stored - 512.0f / 1023.0f) * (1023.0f / 511.0f * kLargestResidual);
}

ALCOVE_MATHS_END

#endif
