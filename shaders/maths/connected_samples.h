// Occluders of finite thickness from the depth samples of one half-slice.
//
// A depth buffer shows only the fronts of occluders. If they are taken as infinitely thick, thin
// objects darken everything behind them. If each sample is an occluder of its own and thin, walls
// leak light between their samples. Therefore two consecutive samples are connected if the depth
// buffer shows that they continue one surface (samples_join). Where a surface begins between two
// samples, its edge is placed between them (kEdgeShare). Every sample has a thickness, either along
// the view direction or up to its back face (height_of_back). A surface that leaves the image is
// extrapolated (kExtrapolationRatio). hidden_occlusion_behind() estimates what lies hidden behind
// an occluder. passes/ALGORITHM.md has figures; sample/README.md compares the estimators.
#ifndef ALCOVE_MATHS_CONNECTED_SAMPLES_H
#define ALCOVE_MATHS_CONNECTED_SAMPLES_H

#include "language.h"

ALCOVE_MATHS_BEGIN

// SliceSample::back, y of it, where no back face tells.
const float kNoBack = 1e30f;

// A depth sample of a half-slice.
struct SliceSample {
  float offset_px;      // from the shaded pixel along the line, growing from sample to sample
  float inverse_depth;  // as the depth buffer has it; linear along the image of any plane
  float off_plane;      // inverse depth at the sample less that of the tangent plane on the line
  vec3 point;           // (x w, y w, w) as slice_point() has it, x outwards
  vec2 back;            // x w and y w of the occluder's end, if back faces tell it
};

// A change of slope of the inverse depth at a sample that parts two surfaces, if there is one.
struct DepthDiscontinuity {
  bool convex;   // the slope before is larger than the slope after
  bool concave;  // the slope before is smaller
};

// `rise` is the change of the inverse depth over an interval of `width` pixels, over 0, before and
// after the sample; `smallest` is the smallest change of slope that counts.
ALCOVE_INLINE DepthDiscontinuity depth_discontinuity(float rise_before, float width_before,
                                                     float rise_after, float width_after,
                                                     float smallest) {
  float change = rise_before * width_after - rise_after * width_before;
  float limit = smallest * width_before * width_after;
  DepthDiscontinuity d;
  d.convex = change > limit;
  d.concave = change < -limit;
  return d;
}

ALCOVE_INLINE bool is_discontinuous(DepthDiscontinuity d) { return d.convex || d.concave; }

// Whether two consecutive samples continue one surface, from the discontinuity at each. A surface
// hardly bends at one of its ends, or bends the same way at both where it meets another in a
// crease. A gap between two surfaces bends sharply one way and then the other.
ALCOVE_INLINE bool samples_join(DepthDiscontinuity here, DepthDiscontinuity there) {
  return !(here.convex && there.concave) && !(here.concave && there.convex);
}

// Whether two successive samples of the second layer are connected. That layer shows fragments of
// many surfaces, where two discontinuities in a row are hardly ever a crease.
ALCOVE_INLINE bool hidden_samples_join(DepthDiscontinuity here, DepthDiscontinuity there) {
  return !(is_discontinuous(here) && is_discontinuous(there));
}

// Where between two samples the edge of the second one's surface is taken to be, if they are on
// two: this fraction of the way back to the first.
const float kEdgeShare = 0.5f;

// Whether a point of the slice's plane stands above the tangent plane by more than a fifth of its
// distance. `height` is the gradient of the height over the tangent plane.
ALCOVE_INLINE bool stands_above_tangent(vec2 point, vec2 height) {
  float above = point.x * height.x + point.y * height.y;
  return above * abs(above) > 0.04f * (point.x * point.x + point.y * point.y);
}

// One less the diamond angle of the back of an occluder whose front has `height` =
// y / (x + |y|) and `scale` = 1 / (x + |y|), a `thickness` along the view direction behind it. It
// is linear in the thickness, which costs no division, and one and a half times as steep as the
// exact function at the front. Gains of 1 to 3 change the mean error in the four development views
// by less than 1.1 %.
ALCOVE_INLINE float height_of_back(float height, float scale, float thickness) {
  return height - thickness * scale * (1.5f - 1.5f * abs(height));
}

// How far a surface goes on beyond the image's border, as a multiple of the way it was searched to
// there.
const float kExtrapolationRatio = 4.0f;

// How far a plane is extrapolated that changes by `slope` in inverse depth per pixel: `way_px`, but
// in perspective no further than to where it lies ten times as far away as its last sample at
// `last`.
ALCOVE_INLINE float extrapolated_way(float last, float slope, float way_px, bool perspective) {
  return perspective ? min(way_px, 0.9f * last / max(-slope, 1e-30f)) : way_px;
}

ALCOVE_MATHS_END

#endif
