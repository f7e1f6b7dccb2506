// Occluders of finite thickness from the depth samples of one side of a slice, joined where they
// lie on one surface.
//
// A depth buffer shows fronts only. Taken as infinitely thick, thin things darken whatever is
// behind them; taken as thin, walls leak light between their samples. So two consecutive samples
// are joined into a sheet when depth alone says that they continue one surface (samples_join),
// every sample has a thickness along the view vector, and the edge of a surface that appears
// between two samples is placed between them (edge_share). What is hidden behind a front stays
// unknown: the mean of thin and infinitely thick, `fill` of the latter, errs less than either (see
// the README's table).
#ifndef ALCOVE_MATHS_CONNECTED_SAMPLES_H
#define ALCOVE_MATHS_CONNECTED_SAMPLES_H

#include "language.h"
#include "slice.h"
#include "visibility_bitmask.h"

ALCOVE_MATHS_BEGIN

// A sample of a side.
struct LineSample {
  float
      offset_px;  // from the shaded pixel along the line, over 0 and growing from sample to sample
  float share;    // 1 / offset_px
  float line;     // linear along the image of any plane: 1/depth in perspective, depth otherwise
  vec2 point;     // in the plane of the slice (slice_line.h), x outwards, scene units
};

// Change of `line` in a pixel between two samples.
ALCOVE_INLINE float line_slope(LineSample from, LineSample to) {
  return (to.line - from.line) / (to.offset_px - from.offset_px);
}

// Whether two samples, next to each other, continue one surface. `bend_here` is the slope of `line`
// before the first of them less the slope between the two; `bend_there` the slope between them less
// the slope after the second. A surface hardly bends at one of its ends, or bends the same way at
// both where it meets another in a crease; a gap between two surfaces bends sharply one way and
// then the other. `sharp` is how much a bend must be to part them.
ALCOVE_INLINE bool samples_join(float bend_here, float bend_there, float sharp) {
  return bend_here * bend_there >= 0.0f || min(abs(bend_here), abs(bend_there)) < sharp;
}

// Where between two samples the edge of the second one's surface is taken to be, if they are on
// two: this part of the way back to the first. Coarser searches miss more of it.
ALCOVE_INLINE float edge_share(uint steps) {
  return steps > 16u ? 0.3f : (steps > 6u ? 0.5f : 0.75f);
}

// sector_position() of one side, in sectors, for points of the slice's plane and at a third of its
// cost: one division, no root and no arc cosine. Within 0.15 of a sector.
struct EdgeScale {
  float view;    // position of the view vector, [0,32]
  float toward;  // sectors for each unit of the two parts of slice_arc()
  float along;
  float tangent;  // y of the tangent plane at x 1
};

ALCOVE_INLINE EdgeScale make_edge_scale(Slice s, SectorScale scale, float side) {
  EdgeScale e;
  e.view = 32.0f * scale.view;
  e.toward = side * 16.0f * scale.inverse_open * s.toward;
  e.along = 16.0f * scale.inverse_open * s.along;
  e.tangent = -side * s.along / max(s.toward, 1e-4f);
  return e;
}

// `point` is (x, y) of LineSample, x at least 0; what lies under the tangent plane counts as on it.
// In [0,32].
ALCOVE_INLINE float edge_position(EdgeScale e, vec2 point) {
  float y = max(point.y, e.tangent * point.x);
  // 0 along the view vector, 1 across it: the angle t measured on a square instead of a circle.
  float w = point.x / max(point.x + abs(y), 1e-30f);
  // sin^2 t, and t - sin t cos t up to a right angle; beyond it the latter is mirrored. Polynomials
  // of least maximum error (0.007, 0.013) among those exact at both ends.
  float w2 = w * w;
  float level = w2 * (((6.5531594f * w - 16.3828966f) * w + 11.1063158f) * w - 0.2765786f);
  float swell = w2 * (((-0.4559529f * w - 3.5528618f) * w + 6.8910025f) * w - 1.3113916f);
  swell = y < 0.0f ? kPi - swell : swell;
  return clamp(e.view + e.toward * level + e.along * swell, 0.0f, 32.0f);
}

// The sectors between two positions in [0,32], in either order, to the nearest boundaries.
ALCOVE_INLINE uint sectors_between(float from, float to) {
  int low = int(min(from, to) + 0.5f);
  int count = int(max(from, to) + 0.5f) - low;
  return count > 0 ? (0xffffffffu >> uint(32 - count)) << uint(low) : 0u;
}

// Where the straight from one point to another, at the distances given, leaves the radius: in
// proportion to the distances.
ALCOVE_INLINE vec2 radius_crossing(vec2 here, float here_distance, vec2 there, float there_distance,
                                   float radius) {
  float part = (radius - here_distance) / (there_distance - here_distance);
  return mix(here, there, clamp(part, 0.0f, 1.0f));
}

// Every sector from the lowest occluded one of a positive side up, or from the highest one of a
// negative side down: what is occluded if occluders are infinitely thick.
ALCOVE_INLINE uint filled_sectors(float side, uint occluded) {
  if (side > 0.0f) return occluded | (0u - occluded);
  uint filled = occluded | (occluded >> 1u);
  filled |= filled >> 2u;
  filled |= filled >> 4u;
  filled |= filled >> 8u;
  return filled | (filled >> 16u);
}

ALCOVE_MATHS_END

#endif
