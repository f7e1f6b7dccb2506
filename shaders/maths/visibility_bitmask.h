// Visibility of a half-slice as a bit mask of sectors, for occluders of finite thickness (after
// Therrien, Levesque and Gilet 2023).
//
// A half-slice is one of the two directions of a slice, `side` = +1 or -1 (maths/slice.h). Its
// directions, from the view direction (sector 0) to the tangent plane (last sector), are divided
// into sectors of equal diamond angle. A bit is set if the sector is occluded.
//
// The diamond angle replaces the angle to the view direction. It is measured along a square instead
// of a circle: 0 along the view direction, 1 perpendicular to it, 2 opposite to it. It grows with
// the angle and costs one division, but no square root and no arc cosine.
//
// Weights are applied after the search. The integral of a weight over the visible sectors is a sum
// of its antiderivative over the boundaries of the runs of occluded sectors; a half-slice has one
// or two such runs. The same mask therefore gives visibility, the bent normal and the visible part
// of a GGX lobe.
#ifndef ALCOVE_MATHS_VISIBILITY_BITMASK_H
#define ALCOVE_MATHS_VISIBILITY_BITMASK_H

#include "bent_normal.h"
#include "gtao.h"
#include "language.h"
#include "slice.h"

ALCOVE_MATHS_BEGIN

// With 31 instead of 32 sectors a position, 0 to 31, fits into five bits, and the sectors between
// two positions, in any order, are the exclusive or of two masks of sectors_beyond().
const uint kSectorCount = 31u;

// Returns the diamond angle, in [0,2], of the direction to a point of the slice's plane. x is at
// least 0 and points away from the view direction, y points along it. Only the ratio of x and y
// matters.
ALCOVE_INLINE float diamond_angle(vec2 point) {
  return 1.0f - point.y / max(point.x + abs(point.y), 1e-30f);
}

// Sine and cosine of the angle to the view direction at a diamond angle in [0,2].
ALCOVE_INLINE vec2 diamond_angle_light(float at) {
  float y = 1.0f - at;
  float x = 1.0f - abs(y);
  float inverse = inversesqrt(x * x + y * y);
  return vec2(x * inverse, y * inverse);
}

// Sine and cosine of the angle between the view direction and the tangent plane in a half-slice.
ALCOVE_INLINE vec2 tangent_light(Slice s, float side) { return vec2(s.cosine, -side * s.sine); }

// Diamond angle of the tangent plane in a half-slice, at least 1e-4.
ALCOVE_INLINE float tangent_diamond_angle(Slice s, float side) {
  return max(diamond_angle(tangent_light(s, side)), 1e-4f);
}

// Bits of the float 2^23, which has no fraction bits: adding it rounds to an integer.
const uint kPositionBits = 0x4b000000u;

// Position among kSectorCount sectors, in the low bits of a word that grows with the position.
// `height` is 1 less the diamond angle, `per_tangent` 1 over tangent_diamond_angle().
ALCOVE_INLINE uint biased_position(float per_tangent, float height) {
  float share = clamp(per_tangent - height * per_tangent, 0.0f, 1.0f);
  return floatBitsToUint(share * float(kSectorCount) + 8388608.0f);
}

// A mask of the bits from `position` (0 to 31) up to bit 31, which is one above the last sector.
// The exclusive or of two such masks holds the sectors between the two positions.
ALCOVE_INLINE uint sectors_beyond(uint position) { return 0xffffffffu << (position & 31u); }

// Repeats the state of the last of kSectorCount sectors in the highest bit, as visible_part()
// and visible_lobe() expect a mask.
ALCOVE_INLINE uint repeat_last_sector(uint occluded) {
  return occluded | ((occluded << 1u) & 0x80000000u);
}

// The share of the sectors from the first occluded one on that is visible, [0,1), for a mask of
// kSectorCount sectors.
ALCOVE_INLINE float visible_share_beyond(uint occluded) {
  uint sectors = occluded & 0x7fffffffu;
  float beyond = float(kSectorCount - lowest_bit(sectors));
  return sectors == 0u ? 0.0f : 1.0f - float(bit_count(sectors)) / beyond;
}

// The visible part of a half-slice.
struct VisiblePart {
  float arc;  // cosine-weighted integral over the visible directions, as light_arc() has it
  vec2 bent;  // weighted sum of the visible directions, as bent_light_arc() has it, or zero
};

ALCOVE_INLINE VisiblePart add_part(VisiblePart sum, float weight, Slice s, float side, vec2 light,
                                   bool bent) {
  sum.arc += weight * light_arc(s, side, light);
  if (bent) sum.bent += bent_light_arc(s, side, light) * weight;
  return sum;
}

// The exponent of hidden_occlusion_behind() if nothing hidden counts as occluded.
const float kNoHiddenOcclusion = 1e3f;

// The exponent with which hidden_occlusion_behind() has the mean `hidden_occlusion`, [0,1], over
// all run shares.
ALCOVE_INLINE float hidden_exponent(float hidden_occlusion) {
  return hidden_occlusion > 0.0f ? max(0.5f / max(hidden_occlusion, 1e-3f) - 0.5f, 0.0f)
                                 : kNoHiddenOcclusion;
}

// The fraction of the volume hidden behind the occluders of a half-slice that counts as occluded,
// [0,1]. It is s^(2 `exponent`), `exponent` is hidden_exponent(), and s, [0,1], is the run share:
// the mean width of an occluder run on the image, relative to the distance from the sample before
// the first run (`before`; 0 if that is the first sample) to the `last` sample. That distance is
// replaced by its geometric mean with `last`, which costs no more and lets a run that reaches the
// last sample have the same share with any number of samples. The volume behind a wall, whose run
// has a share of 1, counts as solid. A blade of grass, or each slat of a blind, has a small share,
// and little of the volume behind it counts as occluded.
ALCOVE_INLINE float hidden_occlusion_behind(float run_width, float before, float last,
                                            float exponent) {
  float squared_share = run_width * run_width / max((last - before) * last, 1e-30f);
  float part = pow(clamp(squared_share, 1e-12f, 1.0f), exponent);
  return exponent < kNoHiddenOcclusion ? part : 0.0f;
}

// Integrates the visible sectors of a half-slice exactly. Visible sectors behind the first occluder
// count by the factor 1 - `hidden_occlusion`, [0,1], because the depth buffer does not show what is
// there. `per_diamond_angle` is the number of sectors per unit of diamond angle. Without occluded
// sectors the result is the open arc, and with all sectors occluded it is 0. VisiblePart::bent is
// computed if `bent` is true.
ALCOVE_INLINE VisiblePart visible_part(Slice s, float side, float per_diamond_angle, uint occluded,
                                       float hidden_occlusion, bool bent) {
  float keep = 1.0f - hidden_occlusion;
  VisiblePart sum;
  sum.arc = 0.0f;
  sum.bent = vec2(0.0f, 0.0f);
  // The weights are those of the antiderivative at the boundaries of runs. The arc up to the first
  // occluder has the weight 1, visible arcs behind it have the weight `keep`.
  float weight = occluded == 0u ? 1.0f : ((occluded >> 31u) != 0u ? 0.0f : keep);
  sum = add_part(sum, weight, s, side, tangent_light(s, side), bent);
  uint ends = occluded ^ (occluded << 1u);
  weight = 1.0f;
  while (ends != 0u) {
    vec2 light = diamond_angle_light(float(lowest_bit(ends)) / per_diamond_angle);
    sum = add_part(sum, weight, s, side, light, bent);
    weight = weight > 0.0f ? -keep : keep;
    ends &= ends - 1u;
  }
  return sum;
}

ALCOVE_MATHS_END

#endif
