// Excludes unobserved directions of a half-slice from the average. passes/ALGORITHM.md, section
// "Unobserved directions", explains the method, which is new here.
//
// Each depth sample stands for one column, a short piece of the slice's line on the image. It is
// unobserved if a foreground hides it, or if it lies beyond the image's border. A row is a run of
// adjacent unobserved columns. A share of the directions between the nearest unobserved column and
// the first occluder is subtracted from both the visible part and the unoccluded part. Nothing is
// excluded from bent normals, which are not quotients.
#ifndef ALCOVE_MATHS_UNOBSERVED_H
#define ALCOVE_MATHS_UNOBSERVED_H

#include "gtao.h"
#include "language.h"
#include "lobe_slice.h"
#include "slice.h"

ALCOVE_MATHS_BEGIN

// The offset that means that there is no unobserved column. It is larger than any other offset.
const float kNowhere = 1e9f;

// The unobserved columns of a half-slice. Lengths along the line are in any one unit.
struct Unobserved {
  float first;  // distance of the nearest unobserved column from the shaded pixel
  float width;  // sum of the widths of the unobserved columns
  float rows;   // number of runs of adjacent unobserved columns
};

ALCOVE_INLINE Unobserved nothing_unobserved() {
  Unobserved none;
  none.first = kNowhere;
  none.width = 0.0f;
  none.rows = 0.0f;
  return none;
}

// Replaces the total width of the unobserved columns by the mean width of a row, because the
// columns beside a narrow row, such as a leaf, mostly show the surface behind it.
ALCOVE_INLINE Unobserved mean_row(Unobserved sum) {
  sum.width = sum.width / max(sum.rows, 1.0f);
  return sum;
}

// The share of a half-slice's directions that is excluded if the whole radius lies beyond the
// image's border, [0,0.5]. It falls to 0 with `other_outside`, the fraction [0,1] of the radius
// that lies beyond the border in the other half-slice, and as `nearness` grows to 1: the radius
// divided by the distance, 0 in orthographic views.
ALCOVE_INLINE float border_share(float other_outside, float nearness) {
  float squared = nearness * nearness;
  return 0.5f * (1.0f - other_outside) * saturate(1.0f - squared * squared);
}

// Adds the part of the radius beyond the border of the image as an unobserved column. `beyond` is
// the length of that part along the line, and `offset` the distance of the last sample before the
// border from the shaded pixel, in the unit of the other lengths; with kNowhere nothing is added.
// The column's width is scaled so that `share` of the directions is excluded if the column is as
// wide as the whole radius.
ALCOVE_INLINE Unobserved add_beyond_border(Unobserved sum, float offset, float beyond,
                                           float share) {
  bool hides = beyond > 0.0f && offset < kNowhere;
  sum.first = min(sum.first, hides ? offset : kNowhere);
  sum.width += hides ? share * share * beyond : 0.0f;
  return sum;
}

// The directions between `from` and `to`, of which a share is excluded.
struct UnobservedArc {
  vec2 from;    // sine and cosine of the angle to the view direction at the arc's beginning
  vec2 to;      // those of its end, which is farther from the view direction
  float share;  // fraction of the arc that is excluded, [0,kMostUnobserved]
};

// The largest share that is excluded. It is less than 1 so that every slice keeps some weight.
const float kMostUnobserved = 0.98f;

// Returns the arc of unobserved directions. It begins at the direction that leaves the sphere of
// the radius in the nearest unobserved column, and ends at `first`, the sine and cosine of the
// angle between the view direction and the first occluder, or the tangent plane if nothing is
// occluded. `radius` is the result of sphere_reach().
ALCOVE_INLINE UnobservedArc make_unobserved_arc(vec2 first, Unobserved unobserved, float radius) {
  UnobservedArc arc;
  float x = min(unobserved.first / radius, 1.0f);
  arc.from = vec2(x, sqrt(1.0f - x * x));
  arc.to = first;
  float share = min(sqrt(unobserved.width / radius), kMostUnobserved);
  arc.share = unobserved.width > 0.0f && arc.to.y < arc.from.y ? share : 0.0f;
  return arc;
}

// Returns the excluded part of a half-slice, weighted by the cosine. `arc_to` is light_arc() of the
// direction at which the arc ends.
ALCOVE_INLINE float unobserved_part(UnobservedArc arc, Slice s, float side, float arc_to) {
  return arc.share * (arc_to - light_arc(s, side, arc.from));
}

// Returns the excluded part of the GGX lobe in a half-slice. `lobe_to` is lobe_light_arc() of the
// direction at which the arc ends.
ALCOVE_INLINE float unobserved_lobe(UnobservedArc arc, HalfLobe lobe, float lobe_to) {
  return arc.share * (lobe_to - lobe_light_arc(lobe, arc.from));
}

ALCOVE_MATHS_END

#endif
