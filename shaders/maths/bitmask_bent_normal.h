// The bent normal of a slice whose visibility is a bitmask of sectors.
//
// Sectors are equal parts of the slice's distribution, which has no inverse in closed form. Each
// edge between visible and hidden sectors is turned back into a horizon by Newton's method, and the
// runs of visible sectors between them are integrated in closed form. A slice has one to three
// runs, so this costs a few edges and not 32 sectors.
#ifndef ALCOVE_MATHS_BITMASK_BENT_NORMAL_H
#define ALCOVE_MATHS_BITMASK_BENT_NORMAL_H

#include "bent_normal.h"
#include "gtao.h"
#include "language.h"
#include "slice.h"
#include "visibility_bitmask.h"

ALCOVE_MATHS_BEGIN

// Cosine of the horizon on a side up to which slice_arc() is `arc`, at least 0; the tangent plane's
// for all that the side holds and more.
ALCOVE_INLINE float horizon_of_arc(Slice s, float side, float arc) {
  float lowest = tangent_horizon(s, side);
  float whole = slice_arc(s, side, lowest);
  float part = whole > 0.0f ? clamp(arc / whole, 0.0f, 1.0f) : 1.0f;
  if (part > 0.99999f) return lowest;
  // Exact for a normal along the view vector, and below the solution for any other.
  float c = mix(lowest, 1.0f, sqrt(1.0f - part));
  for (int i = 0; i < 3; ++i) {
    float slope = c * s.toward + side * s.along * sqrt((1.0f - c) * (1.0f + c));
    c += (slice_arc(s, side, c) - arc) / max(slope, 1e-3f);
    c = clamp(c, lowest, 1.0f);
  }
  return c;
}

// The bent normal's integral from the view vector to a position of the slice's distribution: x
// along the slice's direction, y along the view vector; negative weights on the negative side.
ALCOVE_INLINE vec2 bent_up_to(Slice s, SectorScale scale, float position) {
  float side = position < scale.view ? -1.0f : 1.0f;
  float c = horizon_of_arc(s, side, abs(position - scale.view) * scale.open);
  return bent_arc(s, side, c) * side;
}

// A slice's part of the bent normal, as bent_arc() of both sides: the sum over visible sectors of
// their mean direction, weighted. Within 2e-4 of the integral over those sectors.
ALCOVE_INLINE vec2 bitmask_bent(Slice s, SectorScale scale, uint occluded) {
  vec2 sum = vec2(0.0f, 0.0f);
  uint visible = ~occluded;
  uint end = 0u;
  while (end < 32u && (visible >> end) != 0u) {
    uint first = end + uint(findLSB(visible >> end));
    uint hidden = ~(visible >> first);
    end = min(first + (hidden != 0u ? uint(findLSB(hidden)) : 32u), 32u);
    sum += bent_up_to(s, scale, float(end) / 32.0f) - bent_up_to(s, scale, float(first) / 32.0f);
  }
  return sum;
}

ALCOVE_MATHS_END

#endif
