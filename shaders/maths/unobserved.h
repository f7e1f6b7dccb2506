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
// as the remaining ones, and an open plane stays exactly open. The share is the square root of the
// part of the radius that the unobserved columns are wide. Columns beyond the border count less: if
// they are the whole radius, the share is border_share(), at most 0.5.
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

// An offset where nothing is.
const float kNowherePx = 1e9f;

// The columns along one side of a slice's line that show nothing of the sphere. Those next to each
// other are a row.
struct Unobserved {
  float first_px;  // offset of the innermost from the shaded pixel
  float width_px;  // of all together
  float rows;
  bool last;  // whether the last column is one
};

ALCOVE_INLINE Unobserved nothing_unobserved() {
  Unobserved none;
  none.first_px = kNowherePx;
  none.width_px = 0.0f;
  none.rows = 0.0f;
  none.last = false;
  return none;
}

// Adds the next column, a sample at `offset_px` and `width_px` wide, which hides the sphere or not.
ALCOVE_INLINE Unobserved add_column(Unobserved sum, bool hides, float offset_px, float width_px) {
  sum.first_px = min(sum.first_px, hides ? offset_px : kNowherePx);
  sum.width_px += hides ? width_px : 0.0f;
  sum.rows += hides && !sum.last ? 1.0f : 0.0f;
  sum.last = hides;
  return sum;
}

// As wide as its rows are in the mean: past each of them the columns beside it show what goes on
// there, so that many narrow ones, as leaves are, hide no more than one.
ALCOVE_INLINE Unobserved mean_row(Unobserved sum) {
  sum.width_px = sum.width_px / max(sum.rows, 1.0f);
  return sum;
}

// Share of the directions that go far beyond the image's border on a side which is left out, [0,1].
// Half: some scenes end where the image does, and others go on as they are. None where the other
// side shows nothing of the radius either (`other_outside`: the part of it that lies beyond the
// border there), or where the sphere holds the eye (`nearness`: radius by distance, 0 in
// orthographic views): the little that occludes in the middle of the image would be multiplied.
ALCOVE_INLINE float border_share(float other_outside, float nearness) {
  float squared = nearness * nearness;
  return 0.5f * (1.0f - other_outside) * saturate(1.0f - squared * squared);
}

// Adds `beyond_px` of the radius beyond the image's border, the last sample before it at
// `offset_px` (kNowherePx: nothing is hidden there), so that `share` is left out if that is all of
// the radius.
ALCOVE_INLINE Unobserved add_beyond_border(Unobserved sum, float offset_px, float beyond_px,
                                           float share) {
  bool hides = beyond_px > 0.0f && offset_px < kNowherePx;
  return add_column(sum, hides, offset_px, share * share * beyond_px);
}

// Visible directions, from nearer the view vector outwards, of which a share is left out.
struct UnobservedArc {
  vec2 from;  // sine and cosine of the angle to the view vector
  vec2 to;
  float share;  // [0,kMostUnobserved]
};

// Something of every slice counts.
const float kMostUnobserved = 0.98f;

// From where a direction within the radius meets the innermost unobserved sample to the first
// occluder, or to the tangent plane if nothing is occluded (`first`: sine and cosine of its angle).
// The share is the square root of the part of the radius that the unobserved samples are wide,
// which errs less than the part itself or all of it. `radius_px` is slice_radius_px().
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

// What is left out of a side, as part_arc() weighs it.
ALCOVE_INLINE float unobserved_part(UnobservedArc arc, Slice s, float side, bool uniform_weight) {
  return arc.share *
         (part_arc(s, side, arc.to, uniform_weight) - part_arc(s, side, arc.from, uniform_weight));
}

// The same of the lobe.
ALCOVE_INLINE float unobserved_lobe(UnobservedArc arc, LobeSlice lobe, float side) {
  return arc.share * (lobe_light_arc(lobe, side, arc.to) - lobe_light_arc(lobe, side, arc.from));
}

ALCOVE_MATHS_END

#endif
