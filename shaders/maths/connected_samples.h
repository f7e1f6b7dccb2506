// Occluders of finite thickness from the depth samples of one half-slice.
//
// A depth buffer shows only the front faces of occluders. If occluders are taken as infinitely
// thick, thin objects darken everything behind them. If each sample is a thin occluder of its own,
// light leaks through walls between the samples. Two consecutive samples are therefore connected if
// the depth buffer shows that they lie on one surface (samples_are_connected()); the space between
// them is then occluded too. If a surface begins between two samples, its edge is assumed to be
// halfway between them (kEdgeShare). Every sample has a thickness, either along the view direction
// or up to its back face (height_of_back()). A surface that leaves the image is extrapolated beyond
// the border (kExtrapolationRatio). hidden_occlusion_behind() in visibility_bitmask.h estimates how
// much of the volume behind an occluder is solid. passes/ALGORITHM.md has figures.
#ifndef ALCOVE_MATHS_CONNECTED_SAMPLES_H
#define ALCOVE_MATHS_CONNECTED_SAMPLES_H

#include "language.h"

ALCOVE_MATHS_BEGIN

// The value of SliceSample::back.y if no back face is known.
const float kNoBack = 1e30f;

// A depth sample of a half-slice.
struct SliceSample {
  float inverse_depth;  // of the depth buffer; linear along the image of any plane
  vec3 point;           // (x w, y w, w) of the slice's plane (slice_line.h), x outwards
  vec2 back;            // x w and y w of the occluder's end, if a back face is known
};

// Whether the slope of the depth changes abruptly at a sample, as between two surfaces.
struct DepthDiscontinuity {
  bool convex;   // the slope before is larger than the slope after
  bool concave;  // the slope before is smaller
};

// Returns whether the slope of a line of samples changes abruptly at one of them. `rise_before` and
// `rise_after` are the changes of height over the intervals before and after the sample, whose
// widths, above 0, are `width_before` and `width_after`, in any one unit. `smallest` is the
// smallest change of slope that counts.
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

// Returns whether two consecutive samples lie on one surface, from the discontinuity at each of
// them. On one surface, there is none at one of the two samples at least, or the slope changes in
// the same direction at both, where the surface meets another in a crease. At a gap between two
// surfaces, the slope changes in one direction at one sample and in the other at the next.
ALCOVE_INLINE bool samples_are_connected(DepthDiscontinuity here, DepthDiscontinuity there) {
  return !(here.convex && there.concave) && !(here.concave && there.convex);
}

// Returns whether two consecutive samples of the second depth layer are connected. That layer shows
// fragments of many surfaces, where two discontinuities in a row are hardly ever a crease.
ALCOVE_INLINE bool hidden_samples_are_connected(DepthDiscontinuity here, DepthDiscontinuity there) {
  return !(is_discontinuous(here) && is_discontinuous(there));
}

// The assumed position of the edge of a surface that begins between two consecutive samples, as a
// fraction of the distance from the second sample, which is on this surface, back to the first.
const float kEdgeShare = 0.5f;

// Returns whether a point of the slice's plane lies above the tangent plane by more than a fifth of
// its distance from the shaded point. `height` is the gradient of the height above the tangent
// plane: its dot product with `point` is the height of the point.
ALCOVE_INLINE bool stands_above_tangent(vec2 point, vec2 height) {
  float above = point.x * height.x + point.y * height.y;
  return above * abs(above) > 0.04f * (point.x * point.x + point.y * point.y);
}

// Returns 1 minus the diamond angle of the back of an occluder. The front of the occluder is at a
// point (x, y) of the slice's plane: `height` is y / (x + |y|), which is 1 minus the diamond angle
// of the front, and `scale` is 1 / (x + |y|). The back lies `thickness` behind the front along the
// view direction. The result is linear in the thickness, which needs no division. At the front it
// changes 1.5 times as fast as the exact function. Factors of 1 to 3 instead of 1.5 change the mean
// error in the four development views by less than 1.1 %.
ALCOVE_INLINE float height_of_back(float height, float scale, float thickness) {
  return height - thickness * scale * (1.5f - 1.5f * abs(height));
}

// The largest distance on the image to which a surface is extrapolated beyond the border, as a
// multiple of the distance that was searched within the image.
const float kExtrapolationRatio = 4.0f;

// Returns how far beyond the border a plane is extrapolated: `way`, but in perspective views at
// most until the plane is ten times (chosen) as far from the eye as its last sample. `last` is the
// inverse depth of that sample, and `slope` the change of inverse depth per unit of `way`.
ALCOVE_INLINE float extrapolated_way(float last, float slope, float way, bool perspective) {
  return perspective ? min(way, 0.9f * last / max(-slope, 1e-30f)) : way;
}

ALCOVE_MATHS_END

#endif
