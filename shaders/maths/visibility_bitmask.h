// Visibility of one side of a slice as 32 sectors, for occluders of finite thickness (after
// Therrien, Levesque and Gilet 2023).
//
// Angles are measured on a square instead of a circle, as diamond_angles: 0 along the view
// direction, 1 across it, 2 against it, for one division and no root or arc cosine. A side's
// sectors are equal steps of diamond angle from the view direction (sector 0) to the tangent plane.
// Weights are applied last: any weight with an antiderivative is integrated exactly at the ends of
// the runs of occluded sectors, of which a half-slice has one or two. One search therefore serves
// visibility, bent normal and any lobe.
#ifndef ALCOVE_MATHS_VISIBILITY_BITMASK_H
#define ALCOVE_MATHS_VISIBILITY_BITMASK_H

#include "bent_normal.h"
#include "gtao.h"
#include "language.h"
#include "slice.h"

ALCOVE_MATHS_BEGIN

const uint kSectorCount = 32u;

// The diamond angle of a point in the slice's plane, x outwards from the view direction (at least
// 0), y along it; any length. In [0,2].
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

// Sine and cosine of the angle at which a side meets the tangent plane.
ALCOVE_INLINE vec2 tangent_light(Slice s, float side) { return vec2(s.cosine, -side * s.sine); }

// Diamond angle of the tangent plane in a half-slice, at least 1e-4.
ALCOVE_INLINE float tangent_diamond_angle(Slice s, float side) {
  return max(diamond_angle(tangent_light(s, side)), 1e-4f);
}

// Sectors of a side for each unit of diamond angle, at least 16.
ALCOVE_INLINE float sectors_per_diamond_angle(Slice s, float side) {
  return float(kSectorCount) / tangent_diamond_angle(s, side);
}

// Position of a point among the sectors of its side, in [0,32]; what lies under the tangent plane
// counts as on it.
ALCOVE_INLINE float sector_position(float per_diamond_angle, vec2 point) {
  return min(diamond_angle(point) * per_diamond_angle, float(kSectorCount));
}

// The sectors from one position in [0,32] to another that is no less, to the nearest boundaries.
ALCOVE_INLINE uint sectors_from_to(float from, float to) {
  int low = int(from + 0.5f);
  int count = int(to + 0.5f) - low;
  return count > 0 ? (0xffffffffu >> uint(32 - count)) << uint(low) : 0u;
}

// The same of positions in either order.
ALCOVE_INLINE uint sectors_between(float a, float b) {
  return sectors_from_to(min(a, b), max(a, b));
}

// A cheaper form of the same, for a search that adds an interval per sample. It has one sector
// less, so that a position fits into five bits and an interval between two positions, in either
// order, is the exclusive or of two masks.
const uint kEvenSectorCount = 31u;

// Bits of the float 2^23, which has no fraction bits: adding it rounds to an integer.
const uint kPositionBits = 0x4b000000u;

// Position among kEvenSectorCount sectors, in the low bits of a word that grows with the position.
// `height` is 1 less the diamond angle, `per_tangent` 1 over tangent_diamond_angle().
ALCOVE_INLINE uint biased_position(float per_tangent, float height) {
  float share = clamp(per_tangent - height * per_tangent, 0.0f, 1.0f);
  return floatBitsToUint(share * float(kEvenSectorCount) + 8388608.0f);
}

// A mask of the bits from `position` (0 to 31) up to bit 31, which is one above the last sector.
// The exclusive or of two such masks holds the sectors between the two positions.
ALCOVE_INLINE uint sectors_beyond(uint position) { return 0xffffffffu << (position & 31u); }

// Repeats the state of the last of kEvenSectorCount sectors in the highest bit, as visible_part()
// and visible_lobe() expect a mask.
ALCOVE_INLINE uint repeat_last_sector(uint occluded) {
  return occluded | ((occluded << 1u) & 0x80000000u);
}

// The share of the sectors from the first occluded one on that is visible, [0,1), for a mask of
// kEvenSectorCount sectors.
ALCOVE_INLINE float visible_share_beyond(uint occluded) {
  uint sectors = occluded & 0x7fffffffu;
  float beyond = float(int(kEvenSectorCount) - findLSB(sectors));
  return sectors == 0u ? 0.0f : 1.0f - float(bitCount(sectors)) / beyond;
}

// What is asked of a side.
struct PartRequest {
  bool uniform_weight;  // of part_arc()
  bool bent;
};

// What is visible of a side: as slice_arc() or uniform_arc(), and as bent_arc().
struct VisiblePart {
  float arc;
  vec2 bent;  // zero where it was not asked for
};

// A side from the view direction to a light, cosine-weighted or not.
ALCOVE_INLINE float part_arc(Slice s, float side, vec2 light, bool uniform_weight) {
  return uniform_weight ? uniform_arc(light) : light_arc(s, side, light);
}

ALCOVE_INLINE VisiblePart add_part(VisiblePart sum, float weight, Slice s, float side, vec2 light,
                                   PartRequest request) {
  sum.arc += weight * part_arc(s, side, light, request.uniform_weight);
  if (request.bent) sum.bent += bent_light_arc(s, side, light) * weight;
  return sum;
}

// The exponent of hidden_occlusion_behind() for a mean of `hidden_occlusion`, [0,1].
const float kNoHiddenOcclusion = 1e3f;
ALCOVE_INLINE float hidden_exponent(float hidden_occlusion) {
  return hidden_occlusion > 0.0f ? max(1.0f / max(hidden_occlusion, 1e-3f) - 1.0f, 0.0f)
                                 : kNoHiddenOcclusion;
}

// The fraction of the volume hidden behind the occluders of a half-slice that counts as occluded,
// [0,1]. `front` is the mean width of an occluder run on the image, relative to the distance that
// was searched beyond the first one, [0,1]. A wall hides everything behind it; a blade of grass, or
// each slat of a blind, hides little. `exponent` is hidden_exponent() of the mean over all `front`.
ALCOVE_INLINE float hidden_occlusion_behind(float front, float exponent) {
  float part = pow(clamp(front, 1e-6f, 1.0f), exponent);
  return exponent < kNoHiddenOcclusion ? part : 0.0f;
}

// Exact over the visible sectors. What lies behind an occluder, up to the tangent plane, is
// unknown: the part `hidden_occlusion` of it, [0,1], counts as occluded too. An open side is
// exactly its open arc and a full one exactly 0.
ALCOVE_INLINE VisiblePart visible_part(Slice s, float side, float per_diamond_angle, uint occluded,
                                       float hidden_occlusion, PartRequest request) {
  float keep = 1.0f - hidden_occlusion;
  VisiblePart sum;
  sum.arc = 0.0f;
  sum.bent = vec2(0.0f, 0.0f);
  // The ends of runs, from the view direction outwards: visible up to the first, then of what is
  // visible beyond an occluder only the part that is kept.
  float weight = occluded == 0u ? 1.0f : ((occluded >> 31u) != 0u ? 0.0f : keep);
  sum = add_part(sum, weight, s, side, tangent_light(s, side), request);
  uint ends = occluded ^ (occluded << 1u);
  weight = 1.0f;
  if (ends != 0u) {
    do {
      vec2 light = diamond_angle_light(float(findLSB(ends)) / per_diamond_angle);
      sum = add_part(sum, weight, s, side, light, request);
      weight = weight > 0.0f ? -keep : keep;
      ends &= ends - 1u;
    } while (ends != 0u);
  }
  return sum;
}

ALCOVE_MATHS_END

#endif
