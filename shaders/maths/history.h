// Accumulation over frames: what of the last frame is of the same surface, and a mean while samples
// are few, an exponential average once they are many.
#ifndef ALCOVE_MATHS_HISTORY_H
#define ALCOVE_MATHS_HISTORY_H

#include "raw_occlusion.h"

ALCOVE_MATHS_BEGIN

// How far a held depth lies from the expected one, as a part of that, beyond what holding it in a
// half explains.
ALCOVE_INLINE float held_apart(float expected, float found) {
  return max(abs(found - expected) / max(abs(expected), 1e-6f) - 1.0f / 2048.0f, 0.0f);
}

// How far a texel of history that lies `apart`, of held_apart(), from the expected depth is still
// of the same surface, [0,1]: 1 where it lies 0 from it, 0 from `tolerance` on. `n_dot_v` is the
// cosine between normal and view vector: a surface seen edge-on runs deep within one texel.
ALCOVE_INLINE float history_weight(float apart, float tolerance, float n_dot_v) {
  return clamp(1.0f - apart * max(n_dot_v, 0.1f) * (1.0f / tolerance), 0.0f, 1.0f);
}

// How far normals tell that a texel of history is of the same surface, [0,1], by the square of the
// angle between them, of squared_turn(): 0 from 37 degrees on.
ALCOVE_INLINE float history_weight_by_normal(float squared_angle) {
  return clamp(1.0f - 2.5f * squared_angle, 0.0f, 1.0f);
}

// What this frame weighs when `count` frames are held already (0: none) and at most `longest`
// count: 1 / (count + 1), never less than 1 / longest. So the first frame stands alone, equal
// frames weigh the same, and an old error fades however long the history.
ALCOVE_INLINE float accumulation_weight(float count, float longest) {
  return 1.0f / min(max(count, 0.0f) + 1.0f, max(longest, 1.0f));
}

// The count to store beside the blend: never above `longest`, so that it cannot drift or overflow.
ALCOVE_INLINE float next_count(float count, float longest) {
  return min(max(count, 0.0f) + 1.0f, max(longest, 1.0f));
}

// Mean and spread of a neighbourhood of this frame, from sums over `count` values and their
// squares.
struct Spread {
  float mean;
  float deviation;  // standard deviation of the values, at least 0
};

ALCOVE_INLINE Spread spread_of_sums(float sum, float sum_of_squares, float count) {
  Spread spread;
  spread.mean = sum / max(count, 1.0f);
  float variance = sum_of_squares / max(count, 1.0f) - spread.mean * spread.mean;
  spread.deviation = sqrt(max(variance, 0.0f));
  return spread;
}

// History brought within `width` deviations of the neighbourhood's mean. Noise keeps the deviation
// wide and the history free; a change of light or of occluders pulls it along.
ALCOVE_INLINE float clamp_to_spread(float history, Spread now, float width) {
  float reach = width * now.deviation;
  return clamp(history, now.mean - reach, now.mean + reach);
}

// The count to go on with after clamping moved history from `before` to `after`: all of it when
// nothing moved, a single frame when it moved by `whole` or more.
ALCOVE_INLINE float count_after_clamp(float count, float before, float after, float whole) {
  float moved = clamp(abs(after - before) / max(whole, 1e-6f), 0.0f, 1.0f);
  return mix(count, min(count, 1.0f), moved);
}

// Variance of the visibility that one frame finds, about.
const float kFrameVariance = 0.08f;

// About the variance of the visibility between a surface and what is read in its place where it has
// no texel.
const float kUnobservedVariance = 0.003f;

// The count to go on with after history was read between texels whose visibilities have this
// variance, `missing` of them, [0,1], being of other surfaces. What that blurs no later frame
// brings back, so it counts as so much more noise: `count` frames have kFrameVariance / count of
// it.
ALCOVE_INLINE float count_after_blur(float count, float variance, float missing) {
  variance += kUnobservedVariance * missing;
  return count / (1.0f + count * variance * (1.0f / kFrameVariance));
}

// Linear depth as history holds it, in a half: with a view's scale and offset (history_depth() in
// reconstruct.cpp) it is [0,6e4], whatever the scene's unit.
ALCOVE_INLINE float held_depth(vec2 scale_and_offset, float depth) {
  return min(depth * scale_and_offset.x + scale_and_offset.y, 6e4f);
}

// What a texel of history knows besides its sums over lobes and directions, in 8 bytes.
struct HistoryTexel {
  float visibility;       // [0,1], to 2^-17
  float open;             // of RawOcclusion, as pack_open() has it
  float depth;            // linear, as held_depth() has it, to 2^-11 of itself
  float count;            // frames, [0,kMaxHistoryFrames], whole
  float recent;           // visibility of the last few frames, [0,1], to 2^-8
  uint quantised_normal;  // QuantisedNormal::bits
};

// The most that a pixel's history counts.
const uint kMaxHistoryFrames = 127u;

ALCOVE_INLINE uvec2 pack_history_texel(HistoryTexel texel) {
  uint raw_occlusion = pack_unorm(texel.visibility, 16u) | (pack_open(texel.open) << 16u);
  uint whole = uint(clamp(texel.count, 0.0f, float(kMaxHistoryFrames)) + 0.5f);
  uint state = packHalf2x16(vec2(max(texel.depth, 0.0f), 0.0f)) | (whole << 15u) |
               (pack_unorm(texel.recent, 7u) << 22u);
  // The normal has what either leaves: five bits, and three.
  return uvec2(raw_occlusion | (texel.quantised_normal << 27u),
               state | ((texel.quantised_normal >> 5u) << 29u));
}

ALCOVE_INLINE HistoryTexel unpack_history_texel(uvec2 bits) {
  HistoryTexel texel;
  texel.visibility = unpack_unorm(bits.x, 16u);
  texel.open = unpack_open(bits.x >> 16u);
  texel.depth = unpackHalf2x16(bits.y & 0x7fffu).x;
  texel.count = float((bits.y >> 15u) & 127u);
  texel.recent = unpack_unorm(bits.y >> 22u, 7u);
  texel.quantised_normal = (bits.x >> 27u) | ((bits.y >> 29u) << 5u);
  return texel;
}

// Frames that `recent` is about the mean of.
const float kRecentFrames = 4.0f;

// The mean of the last few frames with one more, [0,1] as they are. `open` is what this frame's
// searches come to for the pixel, weighed as neighbours are: where they are few, across a crease or
// on a sliver, they tell of their own surfaces rather than of a change, and count for less.
ALCOVE_INLINE float recent_visibility(float recent, float count, float now, float open) {
  float known = clamp(1.6f * open, 1e-3f, 1.0f);
  return mix(recent, now, accumulation_weight(count, kRecentFrames / known));
}

// How surely the last few frames, `recent`, see another visibility than all that were gathered,
// `all`, both [0,1]: 0 within the noise of a few searches, which see nothing else in the open and
// in the dark and differ most between, 1 well beyond it.
ALCOVE_INLINE float visibility_changed(float all, float recent) {
  float spread = sqrt(max(min(all * (1.0f - all), recent * (1.0f - recent)), 0.0f));
  float beyond = abs(recent - all) - (0.01f + 0.25f * spread);
  return clamp(beyond * 10.0f, 0.0f, 1.0f);
}

ALCOVE_MATHS_END

#endif
