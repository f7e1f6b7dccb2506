// Excludes unobserved directions of a slice from the average.
//
// A direction is unobserved if, within the radius, it passes through columns of the image in which
// the depth buffer shows nothing of the sphere around the shaded point. Either a foreground nearer
// to the eye than the sphere hides it in those columns, or the columns lie beyond the image's
// border. Whether an occluder lies in such a direction is then unknown. If these directions counted
// as open, as the horizon estimators count them, the result behind foregrounds would be too bright,
// and the more so the larger the hidden part of a direction's path is.
//
// Therefore a share of the directions between the innermost unobserved column and the first
// occluder is excluded: it is subtracted from both the visible part and the unoccluded part, and
// visibility is the quotient of the two. Excluded directions are thereby assumed to be as visible
// as the remaining ones, and an open plane stays exactly open. The share is the square root of w /
// r, where r is the radius on the image and w the mean width of a row, a run of adjacent unobserved
// columns. Columns beyond the border count less: if they are the whole radius, the share is
// border_share(), at most 0.5.
//
// A bent normal is a mean direction and no such quotient, so nothing is excluded from it. The
// method is new here; it is not taken from a paper.
#ifndef ALCOVE_MATHS_UNOBSERVED_H
#define ALCOVE_MATHS_UNOBSERVED_H

#include "gtao.h"
#include "language.h"
#include "lobe_slice.h"
#include "slice.h"
#include "visibility_bitmask.h"

ALCOVE_MATHS_BEGIN

// The offset of the innermost unobserved column if there is none.
const float kNowherePx = 1e9f;

// The unobserved columns of a half-slice. Each sample is a column of the image. Adjacent unobserved
// columns form a row.
struct Unobserved {
  float first_px;  // offset of the innermost one from the shaded pixel
  float width_px;  // sum of the widths
  float rows;      // number of rows
  bool last;       // whether the outermost column that was added is unobserved
};

ALCOVE_INLINE Unobserved nothing_unobserved() {
  Unobserved none;
  none.first_px = kNowherePx;
  none.width_px = 0.0f;
  none.rows = 0.0f;
  none.last = false;
  return none;
}

// Adds the next column outwards, a sample at `offset_px` that is `width_px` wide. `hides` says
// whether it is unobserved.
ALCOVE_INLINE Unobserved add_column(Unobserved sum, bool hides, float offset_px, float width_px) {
  sum.first_px = min(sum.first_px, hides ? offset_px : kNowherePx);
  sum.width_px += hides ? width_px : 0.0f;
  sum.rows += hides && !sum.last ? 1.0f : 0.0f;
  sum.last = hides;
  return sum;
}

// Replaces the total width by the mean width of a row. Beyond each row the columns next to it show
// what lies there, so many narrow rows, such as leaves, hide no more than one of them does.
ALCOVE_INLINE Unobserved mean_row(Unobserved sum) {
  sum.width_px = sum.width_px / max(sum.rows, 1.0f);
  return sum;
}

// The share of a half-slice's directions that is excluded if the whole radius lies beyond the
// image's border, [0,0.5]. The 0.5 is a compromise: some scenes end at the border of the image, and
// others continue unchanged. The share falls to 0 as more of the radius lies beyond the border in
// the other half-slice too (`other_outside`, the fraction of the radius, [0,1]), and as the eye
// comes to lie within the sphere (`nearness`: radius divided by distance, 0 in orthographic views).
// In both cases the little occlusion that is observed would otherwise be amplified.
ALCOVE_INLINE float border_share(float other_outside, float nearness) {
  float squared = nearness * nearness;
  return 0.5f * (1.0f - other_outside) * saturate(1.0f - squared * squared);
}

// Adds the `beyond_px` pixels of the radius that lie beyond the image's border as a column. The
// last sample before the border is at `offset_px`; nothing is added if that is kNowherePx. If the
// column is all of the radius, `share` of the directions is excluded.
ALCOVE_INLINE Unobserved add_beyond_border(Unobserved sum, float offset_px, float beyond_px,
                                           float share) {
  bool hides = beyond_px > 0.0f && offset_px < kNowherePx;
  return add_column(sum, hides, offset_px, share * share * beyond_px);
}

// An arc of visible directions of which a share is excluded. `from` is nearer to the view direction
// than `to`.
struct UnobservedArc {
  vec2 from;  // sine and cosine of the angle to the view direction
  vec2 to;
  float share;  // [0,kMostUnobserved]
};

// The largest share that is excluded, so that a part of every slice counts.
const float kMostUnobserved = 0.98f;

// Returns the arc from the direction that reaches the innermost unobserved sample at the distance
// of the radius, to the first occluder, or to the tangent plane if nothing is occluded (`first`:
// sine and cosine of its angle to the view direction). The share is the square root of the part of
// the radius that the unobserved samples are wide; its error is smaller than that of the part
// itself and of excluding all. `radius_px` is slice_radius_px().
ALCOVE_INLINE UnobservedArc make_unobserved_arc(vec2 first, Unobserved unobserved,
                                                float radius_px) {
  UnobservedArc arc;
  float x = min(unobserved.first_px / radius_px, 1.0f);
  arc.from = vec2(x, sqrt(1.0f - x * x));
  arc.to = first;
  float share = min(sqrt(unobserved.width_px / radius_px), kMostUnobserved);
  arc.share = unobserved.width_px > 0.0f && arc.to.y < arc.from.y ? share : 0.0f;
  return arc;
}

// Returns the excluded part of a half-slice, weighted as part_arc() weights it.
ALCOVE_INLINE float unobserved_part(UnobservedArc arc, Slice s, float side, bool uniform_weight) {
  return arc.share *
         (part_arc(s, side, arc.to, uniform_weight) - part_arc(s, side, arc.from, uniform_weight));
}

// Returns the excluded part of the GGX lobe in a half-slice.
ALCOVE_INLINE float unobserved_lobe(UnobservedArc arc, LobeSlice lobe, float side) {
  return arc.share * (lobe_light_arc(lobe, side, arc.to) - lobe_light_arc(lobe, side, arc.from));
}

ALCOVE_MATHS_END

#endif
