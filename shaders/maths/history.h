// Accumulation over frames [Jimenez 2016, section 4.5]: which texels of the previous frame show the
// same surface, how much they weigh against the samples of this frame, and how a texel is stored.
#ifndef ALCOVE_MATHS_HISTORY_H
#define ALCOVE_MATHS_HISTORY_H

#include "packing.h"

ALCOVE_MATHS_BEGIN

// The largest weight, in frames, that a pixel's history can have.
const uint kMaxHistoryFrames = 127u;

// Mean and standard deviation of a neighbourhood of this frame.
struct Spread {
  float mean;
  float deviation;  // at least 0
};

// From the sums over `count` values and their squares.
ALCOVE_INLINE Spread spread_of_sums(float sum, float sum_of_squares, float count) {
  Spread spread;
  spread.mean = sum / max(count, 1.0f);
  float variance = sum_of_squares / max(count, 1.0f) - spread.mean * spread.mean;
  spread.deviation = sqrt(max(variance, 0.0f));
  return spread;
}

// The history clamped to `width` standard deviations around the neighbourhood's mean. Noise keeps
// the deviation wide, so the history passes; a change of light or of occluders moves it.
ALCOVE_INLINE float clamp_to_spread(float history, Spread now, float width) {
  float half_width = width * now.deviation;
  return clamp(history, now.mean - half_width, now.mean + half_width);
}

// The history's weight after a clamp moved its value from `before` to `after`: unchanged where the
// value did not move, at most one frame where it moved by `whole` or more.
ALCOVE_INLINE float weight_after_clamp(float weight, float before, float after, float whole) {
  float moved = clamp(abs(after - before) / max(whole, 1e-6f), 0.0f, 1.0f);
  return mix(weight, min(weight, 1.0f), moved);
}

// Variance of the visibility that one frame measures at a pixel. Tuned with `alcove motion --path
// orbit` in one view, and checked in another.
const float kFrameVariance = 0.02f;

// Variance of the visibility between a surface and its neighbours that stand in for a history texel
// of another surface. Mean over the development scenes.
const float kMissingVariance = 0.003f;

// The history's weight after it was interpolated between texels whose visibilities have the given
// variance, `missing` of them, [0,1], being of other surfaces. Interpolation blurs, which no later
// frame undoes, so its variance is added to the noise: `weight` frames have kFrameVariance /
// weight.
ALCOVE_INLINE float weight_after_blur(float weight, float variance, float missing) {
  variance += kMissingVariance * missing;
  return weight / (1.0f + weight * variance * (1.0f / kFrameVariance));
}

// A texel of the history, stored in 4 bytes.
//
// `weight` is the sum of the weights that this pixel's samples had, in frames: 1 is what one frame
// adds in the mean on a plane. It takes the place of a frame count and of the filter's own weight.
struct HistoryTexel {
  float depth;       // of history_depth(), [0,1], to 2^-15
  float occlusion;   // 1 - visibility, [0,1]; 0 is exact
  float recent;      // occlusion of the last few frames, [0,1], by its root; 0 is exact
  float log_weight;  // of log_weight_of(), [0,1]; 0 is exact
};

// Weights are stored as logarithms: from 2^-4, which stands for none, to 2^7 frames.
const float kLeastLogWeight = -4.0f;
const float kLogWeightRange = 11.0f;

// The logarithm of a weight of 0 to kMaxHistoryFrames frames, scaled to [0,1].
ALCOVE_INLINE float log_weight_of(float weight) {
  return (log2(max(weight, 0.0f) + 0.0625f) - kLeastLogWeight) * (1.0f / kLogWeightRange);
}

ALCOVE_INLINE float weight_of_log(float log_weight) {
  return exp2(log_weight * kLogWeightRange + kLeastLogWeight) - 0.0625f;
}

// A depth as the history stores it, [0,1]. `scale_and_offset` is history_depth_scale() of the view
// (reconstruct.cpp). In perspective views `inverse_depth` is 1/depth and the result is proportional
// to the logarithm of depth, so that differences are relative; in orthographic views it is the
// depth and the result is linear. `log_inverse_depth` is the base-2 logarithm of 1/depth, or the
// depth.
ALCOVE_INLINE float history_depth(vec2 scale_and_offset, float log_inverse_depth) {
  return clamp(log_inverse_depth * scale_and_offset.x + scale_and_offset.y, 0.0f, 1.0f);
}

// The weight of a history texel whose depth differs from the expected one by `difference` (any
// unit), [0,1]: 1 within `slack`, which is what storing a depth rounds, 0 from
// `slack` + 1/`sharpness` on.
ALCOVE_INLINE float history_agreement(float difference, float slack, float sharpness) {
  float linear = clamp(1.0f - (abs(difference) - slack) * sharpness, 0.0f, 1.0f);
  return linear * linear;
}

// x in [0,1] as an integer of `bits` bits, as a float. `dither` in [0,1) replaces the 0.5 of
// rounding to nearest: where it varies evenly over frames and pixels the mean is exact. 0 stays 0.
ALCOVE_INLINE float dithered(float x, uint bits, float dither) {
  float last = float((1u << bits) - 1u);
  return min(floor(clamp(x, 0.0f, 1.0f) * last + dither), last);
}

// `bits` bits of a word from bit `first` on as a number in [0,1], without an integer conversion,
// which GPUs do at a quarter of their rate: the bits become the mantissa of a float in [1,2).
ALCOVE_INLINE float unpack_mantissa(uint word, uint first, uint bits) {
  uint last = (1u << bits) - 1u;
  uint mantissa = first + bits > 23u ? word >> (first + bits - 23u) : word << (23u - first - bits);
  float scale = float(1u << bits) / float(last);
  return uintBitsToFloat((mantissa & (last << (23u - bits))) | 0x3f800000u) * scale - scale;
}

// A logarithmic weight quantised to a whole number from 0 to 15, returned as a float. `dither`
// rounds up at random, with a probability that preserves the mean of the weight rather than of its
// logarithm. The weights of successive codes differ by a factor of 2^(11/15). At a fraction f
// between two codes the exact probability is (2^(11/15 f) - 1) / (2^(11/15) - 1); the polynomial is
// within 2.2e-3 of it.
ALCOVE_INLINE float dithered_log_weight(float log_weight, float dither) {
  float code = clamp(log_weight, 0.0f, 1.0f) * 15.0f;
  float whole = floor(code);
  float part = code - whole;
  return whole + (part * (part * 0.253f + 0.747f) + dither >= 1.0f ? 1.0f : 0.0f);
}

// 14 bits of depth, 10 of occlusion, 4 of recent occlusion, 4 of weight. The last three are put
// together as floats, which is cheaper than three conversions.
ALCOVE_INLINE uint pack_history_texel(HistoryTexel texel, float dither) {
  float low_bits = dithered(texel.occlusion, 10u, dither) * 256.0f +
                   dithered(sqrt(max(texel.recent, 0.0f)), 4u, dither) * 16.0f +
                   dithered_log_weight(texel.log_weight, dither);
  return (uint(texel.depth * 16383.0f + 0.5f) << 18u) | uint(low_bits);
}

ALCOVE_INLINE float texel_depth(uint bits) { return unpack_mantissa(bits, 18u, 14u); }
ALCOVE_INLINE float texel_occlusion(uint bits) { return unpack_mantissa(bits, 8u, 10u); }
ALCOVE_INLINE float texel_recent(uint bits) {
  float root = unpack_mantissa(bits, 4u, 4u);
  return root * root;
}
ALCOVE_INLINE float texel_log_weight(uint bits) { return unpack_mantissa(bits, 0u, 4u); }

ALCOVE_INLINE HistoryTexel unpack_history_texel(uint bits) {
  HistoryTexel texel;
  texel.depth = texel_depth(bits);
  texel.occlusion = texel_occlusion(bits);
  texel.recent = texel_recent(bits);
  texel.log_weight = texel_log_weight(bits);
  return texel;
}

// The GGX lobe's history in 2 bytes: 9 bits of occlusion and 7 of the logarithm of its open part,
// 2^-12 to 2^4, since it differs by orders of magnitude between roughnesses.
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

// Frames over which the recent occlusion is averaged, about.
const float kRecentFrames = 4.0f;

// The mean of the last few frames with this frame's `now` added, all in [0,1]. `weight` is that of
// the history. `open` is the weight that this frame's samples have at the pixel: where it is small,
// at a crease or on a sliver, they belong to other surfaces and count for less.
ALCOVE_INLINE float update_recent(float recent, float weight, float now, float open) {
  float known = clamp(1.6f * open, 1e-3f, 1.0f);
  return mix(recent, now, 1.0f / min(max(weight, 0.0f) + 1.0f, kRecentFrames / known));
}

// How surely the last few frames, `recent`, measure another visibility than the whole history,
// `all`, both [0,1]: 0 within the noise of a few samples, which is largest between open and
// occluded, 1 well beyond it.
ALCOVE_INLINE float visibility_changed(float all, float recent) {
  float spread = sqrt(max(min(all * (1.0f - all), recent * (1.0f - recent)), 0.0f));
  float beyond = abs(recent - all) - (0.01f + 0.25f * spread);
  return clamp(beyond * 10.0f, 0.0f, 1.0f);
}

ALCOVE_MATHS_END

#endif
