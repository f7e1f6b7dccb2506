// A texel of 2x2 pixels that was reconstructed at half resolution: its occlusion and the tangent
// plane of its surface. The upsampling pass computes pixels from it, and the next frame reads it as
// history. It is stored in two images, which texture units unpack:
//   R16G16B16A16_SNORM, pack_half_texel()
//     | r: occlusion | g: weight / 128 | b: tilt x / 16 | a: tilt y / 16 |
//   R32_SFLOAT, half_texel_depth()
//     | inverse depth, a float 24 | recent 8 |  1 + the code of the recent occlusion, or 0
#ifndef ALCOVE_MATHS_HALF_TEXEL_H
#define ALCOVE_MATHS_HALF_TEXEL_H

#include "language.h"
#include "raw_occlusion.h"
#include "slice_line.h"

ALCOVE_MATHS_BEGIN

// Largest component of a tilt, 86 degrees; larger ones are stored as this.
const float kLargestTilt = 16.0f;

// Weights are stored in units of so many frames.
const float kHalfTexelWeightUnit = 128.0f;

struct HalfTexel {
  float occlusion;  // 1 - visibility, [0,1]; error 2^-16; 0 and 1 are exact
  float weight;     // of the history, frames, [0,kMaxHistoryFrames]
  // The slope of the plane: the xy components of the view-space normal, divided by minus its
  // component along the view ray of unit depth. Multiplied by ray_per_px(), and in perspective
  // views also by -inverse_depth, it is the change of inverse depth from one pixel to the next.
  vec2 tilt;
};

// Returns the texel as it is stored in R16G16B16A16_SNORM, which clamps tilts that are too large.
ALCOVE_INLINE vec4 pack_half_texel(HalfTexel texel) {
  return vec4(texel.occlusion, texel.weight * (1.0f / kHalfTexelWeightUnit),
              texel.tilt * (1.0f / kLargestTilt));
}

// Returns the value stored in R32_SFLOAT: the inverse depth of the plane at the texel's centre,
// which must be at least 0. If `knows_recent`, the last eight bits of the mantissa are replaced by
// the mean occlusion of the last few frames, `recent`, [0,1]. The relative error of the depth is
// 2^-15.
ALCOVE_INLINE float half_texel_depth(float inverse_depth, float recent, bool knows_recent) {
  uint bits = floatBitsToUint(inverse_depth) & 0xffffff00u;
  uint code = knows_recent ? uint(sqrt(clamp(recent, 0.0f, 1.0f)) * 254.0f + 1.5f) : 0u;
  return uintBitsToFloat(bits | code);
}

// Returns 1 plus the code in `depth` of the mean occlusion of the last few frames, over 256. The
// code becomes the mantissa of a float, because GPUs convert integers at a quarter of their usual
// rate.
ALCOVE_INLINE float half_texel_recent_code(float depth) {
  return uintBitsToFloat(((floatBitsToUint(depth) << 15u) & 0x007f8000u) | 0x3f800000u);
}

// Returns the mean occlusion of the last few frames for a result of half_texel_recent_code(), or
// for a weighted mean of such results. The result is `otherwise` if none is stored, which texels of
// one frame have in common.
ALCOVE_INLINE float half_recent_of_code(float code, float otherwise) {
  float root = max(code * (256.0f / 254.0f) - 257.0f / 254.0f, 0.0f);
  return code < 1.0f + 0.5f / 256.0f ? otherwise : root * root;
}

// Returns the value of a bent-normal residual (bent_normal.h) in A2B10G10R10_UNORM. A component of
// 0 is stored exactly. `dither`, [0,1), replaces the 0.5 that is added to round to nearest.
ALCOVE_INLINE vec4 pack_half_residual(vec3 residual, float dither) {
  float scale = 511.0f / (1023.0f * kLargestResidual);
  float offset = (511.5f + dither) * (1.0f / 1023.0f);
  return vec4(residual * scale + offset, 0.0f);
}

// The stored value of a residual of 0, and the residual for a stored difference of 1.
const float kZeroHalfResidual = 512.0f / 1023.0f;
const float kHalfResidualUnit = 1023.0f / 511.0f * kLargestResidual;

ALCOVE_INLINE vec3 unpack_half_residual(vec3 stored) {
  return (stored - kZeroHalfResidual) * kHalfResidualUnit;
}

// Returns the raw depth of the pixel that represents a texel, from those of its four pixels in any
// order: the nearest one if x + y of the texel is even, and otherwise the farthest, like the
// squares of a chessboard. Where two surfaces meet, both are then found among any 2x2 texels. A
// pixel of the sky represents a texel only if all four show the sky.
ALCOVE_INLINE float representative_depth(ivec2 texel, vec4 depths_ndc, bool reversed) {
  float smallest = min(min(depths_ndc.x, depths_ndc.y), min(depths_ndc.z, depths_ndc.w));
  float largest = max(max(depths_ndc.x, depths_ndc.y), max(depths_ndc.z, depths_ndc.w));
  float nearest = reversed ? largest : smallest;
  float farthest = reversed ? smallest : largest;
  bool takes_nearest = ((texel.x ^ texel.y) & 1) == 0 || is_sky_ndc(farthest, reversed);
  return takes_nearest ? nearest : farthest;
}

ALCOVE_MATHS_END

#endif
