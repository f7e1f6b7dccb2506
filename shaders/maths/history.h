// Temporal accumulation [Jimenez 2016, section 4.5]: decides which texels of the previous frame
// show the same surface and how much they weigh against the samples of this frame, and packs the
// texels of the history.
#ifndef ALCOVE_MATHS_HISTORY_H
#define ALCOVE_MATHS_HISTORY_H

#include "packing.h"

ALCOVE_MATHS_BEGIN

// The largest weight, in frames, that a pixel's history can have.
const uint kMaxHistoryFrames = 127u;
const float kInverseRootOfMaxHistoryFrames = 0.0887357f;

// Variance of the visibility that one frame measures at a pixel. Tuned in one view (`alcove motion
// --path orbit`), and checked in another.
const float kFrameVariance = 0.02f;

// Variance of the error of visibility if a history texel shows another surface and neighbouring
// texels are used instead. It is the mean over the development scenes.
const float kMissingVariance = 0.003f;

// Returns the history's weight after interpolation between four texels whose visibilities have the
// variance `variance`. `missing`, [0,1], is the fraction of the bilinear weights whose texels show
// other surfaces. Interpolation blurs the history, and later frames do not undo it. Its variance is
// therefore added to the variance of the noise, which is kFrameVariance / weight for `weight`
// frames, and the result is the weight that has this sum as its noise.
ALCOVE_INLINE float weight_after_blur(float weight, float variance, float missing) {
  variance += kMissingVariance * missing;
  return weight / (1.0f + weight * variance * (1.0f / kFrameVariance));
}

// Returns a depth as the history stores it, [0,1]. `scale_and_offset` is the result of
// history_depth_scale() for the view (reconstruct_uniforms.cpp). In perspective views,
// `log_inverse_depth` is the base-2 logarithm of 1/depth, and equal steps of the result are equal
// relative differences of depth. In orthographic views, `log_inverse_depth` is the depth itself,
// and the result is linear.
ALCOVE_INLINE float history_depth(vec2 scale_and_offset, float log_inverse_depth) {
  return clamp(log_inverse_depth * scale_and_offset.x + scale_and_offset.y, 0.0f, 1.0f);
}

// Returns the weights, [0,1], of four texels of the history, whose depths lie at `distances` from
// the pixel's tangent plane. A weight is 1 if the distance is at most `slack`, the rounding error
// of a stored depth, and 0 if it is at least `slack` + 1.
ALCOVE_INLINE vec4 history_agreement(vec4 distances, float slack) {
  vec4 linear = clamp(1.0f + slack - abs(distances), 0.0f, 1.0f);
  return linear * linear;
}

// Returns x, [0,1], as an integer of `bits` bits, in a float. `dither`, [0,1), replaces the 0.5
// that is added to round to nearest. If it varies evenly over frames and pixels, the mean of the
// results is exact. 0 stays 0.
ALCOVE_INLINE float dithered(float x, uint bits, float dither) {
  float last = float((1u << bits) - 1u);
  return min(floor(clamp(x, 0.0f, 1.0f) * last + dither), last);
}

// Returns `bits` bits of a word, from bit `first` on, as a number in [0,1]. The bits become the
// mantissa of a float in [1,2), because GPUs convert integers at a quarter of their usual rate.
ALCOVE_INLINE float unpack_mantissa(uint word, uint first, uint bits) {
  uint last = (1u << bits) - 1u;
  uint mantissa = first + bits > 23u ? word >> (first + bits - 23u) : word << (23u - first - bits);
  float scale = float(1u << bits) / float(last);
  return uintBitsToFloat((mantissa & (last << (23u - bits))) | 0x3f800000u) * scale - scale;
}

// A texel of the history of pixels. It is stored in the two channels of R16G16_UNORM, which texture
// units convert to floats, so that two gathers read what the next frame needs of four texels:
//      15                                    0
//   r | depth                  13 | recent   3 |  1 + the code of the recent occlusion, or 0
//   g | weight 5 | occlusion                11 |
struct HistoryTexel {
  float depth;  // of history_depth(), [0,1], to 2^-14
  // Occlusion of the last few frames, [0,1], or kNoRecent; its root in 7 steps; 0 is exact.
  float recent;
  float occlusion;  // 1 - visibility, [0,1], in 11 bits; 0 is exact
  // The sum of the filter weights that the samples had for this pixel, [0,kMaxHistoryFrames], in
  // frames: on a plane, a frame adds 1 on average. It is used instead of a frame count. Its square
  // root is stored in 5 bits; 0 is exact.
  float weight;
};

// The largest code of a weight, in 5 bits. Code c stands for a weight of kMaxHistoryFrames
// (c/31)^2.
const float kLastWeightCode = 31.0f;
// The largest code of an occlusion, in 11 bits. Code c stands for an occlusion of c/2047.
const float kLastOcclusionCode = 2047.0f;

// The recent occlusion of a frame that does not compute it.
const float kNoRecent = -1.0f;

// Packs a texel. `dither`, [0,1), replaces the 0.5 that is added to round to nearest. The depth is
// rounded such that the whole first component differs from it by at most 4.2/65535 and can be used
// as the depth without unpacking.
ALCOVE_INLINE vec2 pack_history_texel(HistoryTexel texel, float dither) {
  float recent =
      texel.recent < 0.0f ? 0.0f : min(floor(sqrt(texel.recent) * 6.0f + (1.0f + dither)), 7.0f);
  float depth = floor(texel.depth * (65535.0f / 8.0f) - recent * (1.0f / 8.0f) + 0.5f);
  float code =
      floor(sqrt(texel.weight) * (kLastWeightCode * kInverseRootOfMaxHistoryFrames) + dither);
  float occlusion = floor(texel.occlusion * kLastOcclusionCode + dither);
  return vec2(clamp(depth, 0.0f, 8191.0f) * 8.0f + recent,
              min(code, kLastWeightCode) * 2048.0f + occlusion) *
         (1.0f / 65535.0f);
}

// Returns the code of the recent occlusion from the first component of a packed texel, in eighths
// and plus a sixteenth: the fraction of the component's code over eight.
ALCOVE_INLINE float texel_recent_code(float first) {
  return fract(first * (65535.0f / 8.0f) + 0.5f / 8.0f);
}

// Returns the recent occlusion for a result of texel_recent_code(), or for a weighted mean of such
// results. The result is `otherwise` if none is stored, which texels of one frame have in common.
ALCOVE_INLINE float recent_of_code(float code, float otherwise) {
  float root = max(code * (8.0f / 6.0f) - 1.5f / 6.0f, 0.0f);
  return code < 1.0f / 8.0f ? otherwise : root * root;
}

// Converts the second component of a packed texel to a number whose whole part is the code of the
// weight. texel_occlusion() decodes its fraction.
ALCOVE_INLINE float texel_codes(float second) {
  return second * (65535.0f / 2048.0f) + 0.5f / 2048.0f;
}

// Returns the occlusion from the fraction of a result of texel_codes(), or from a weighted mean of
// such fractions. For an occlusion of 0 the result is at most 0: rounding adds up to 3e-6 to the
// fraction, which is subtracted.
ALCOVE_INLINE float texel_occlusion(float fraction) {
  return (fraction - (0.5f / 2048.0f + 3e-6f)) * (2048.0f / kLastOcclusionCode);
}

// Returns the weight for a weight's code, or for a weighted mean of codes.
ALCOVE_INLINE float weight_of_code(float code) {
  return code * code * (float(kMaxHistoryFrames) / (kLastWeightCode * kLastWeightCode));
}

ALCOVE_INLINE HistoryTexel unpack_history_texel(vec2 stored) {
  HistoryTexel texel;
  texel.depth = stored.x;
  float codes = texel_codes(stored.y);
  texel.occlusion = max(texel_occlusion(fract(codes)), 0.0f);
  texel.recent = recent_of_code(texel_recent_code(stored.x), texel.occlusion);
  texel.weight = weight_of_code(floor(codes));
  return texel;
}

// The history of a GGX lobe, R16_UINT. The logarithm of the unoccluded part, between 2^-12 and 2^4,
// is stored because it differs by orders of magnitude between roughnesses. From the highest bit:
//     | occlusion 9 | log2(open) 7 |
struct LobeTexel {
  float occlusion;  // [0,1]; 0 is exact
  float open;       // of the lobe's RawOcclusion for a weight of 1; 0 is exact
};

ALCOVE_INLINE uint pack_lobe_texel(LobeTexel texel, float dither) {
  float log_open = (log2(max(texel.open, 0.0f) + 0.000244140625f) + 12.0f) * (1.0f / 16.0f);
  return uint(dithered(texel.occlusion, 9u, dither) * 128.0f + dithered(log_open, 7u, dither));
}

ALCOVE_INLINE LobeTexel unpack_lobe_texel(uint bits) {
  LobeTexel texel;
  texel.occlusion = unpack_mantissa(bits, 7u, 9u);
  texel.open = exp2(unpack_mantissa(bits, 0u, 7u) * 16.0f - 12.0f) - 0.000244140625f;
  return texel;
}

// Approximate number of frames over which the recent occlusion is averaged.
const float kRecentFrames = 4.0f;

// Returns the mean occlusion of the last few frames after adding this frame's value `now`, all in
// [0,1]. `weight` is the weight of the history in frames. `open` is the weight that this frame's
// samples have for the pixel. If it is small, at a crease or on a narrow surface, the samples
// belong to other surfaces and change the mean less.
ALCOVE_INLINE float update_recent(float recent, float weight, float now, float open) {
  float known = clamp(1.6f * open, 1e-3f, 1.0f);
  return mix(recent, now, max(1.0f / (max(weight, 0.0f) + 1.0f), known * (1.0f / kRecentFrames)));
}

// Returns how certain it is, [0,1], that the mean of the last few frames, `recent`, differs from
// the mean of the whole history, `all`: 0 if the difference is within the noise of a few samples,
// and 1 if it is 0.1 (chosen) above. The noise is assumed to be largest for a visibility of 0.5.
ALCOVE_INLINE float visibility_changed(float all, float recent) {
  float spread = sqrt(max(min(all * (1.0f - all), recent * (1.0f - recent)), 0.0f));
  float beyond = abs(recent - all) - (0.01f + 0.25f * spread);  // of the mean of 16 times 0 or 1
  return clamp(beyond * 10.0f, 0.0f, 1.0f);
}

ALCOVE_MATHS_END

#endif
