// Areas of spherical caps and of their intersections.
//
// Angles are in radians: `a` and `b` are the half-angles of two caps, in [0,pi/2], and `d` is the
// angle between their axes, in [0,pi]. Areas are in steradians.
#ifndef ALCOVE_MATHS_SPHERICAL_CAP_H
#define ALCOVE_MATHS_SPHERICAL_CAP_H

#include "constants.h"
#include "language.h"

ALCOVE_MATHS_BEGIN

// Returns the area of a cap, 2 pi (1 - cos a), in a form without cancellation for small caps.
ALCOVE_INLINE float cap_area(float a) {
  float s = sin(0.5f * a);
  return 4.0f * kPi * s * s;
}

// Returns twice the area of a spherical triangle with two sides and the angle between them.
ALCOVE_INLINE float twice_triangle_area(float side_1, float side_2, float angle) {
  float t = tan(0.5f * side_1) * tan(0.5f * side_2);
  return 4.0f * atan(t * sin(angle), 1.0f + t * cos(angle));
}

// Returns the exact area of the intersection of two caps: the sum of the two sectors between the
// points where the rims cross, minus the kite that both sectors cover. The error is within 1e-6 /
// min(a,b) of the smaller cap's area.
ALCOVE_INLINE float cap_intersection(float a, float b, float d) {
  float small = min(a, b);
  float large = max(a, b);
  if (d >= small + large) return 0.0f;
  if (d <= large - small) return cap_area(small);
  // The three corners of a spherical triangle are the two axes and a point where the rims cross.
  // Its angles are computed by the half-angle formula.
  float whole = max(sin(0.5f * (large + d + small)), 1e-20f);
  float less_small = max(sin(0.5f * (large + d - small)), 1e-20f);
  float less_large = max(sin(0.5f * (small + (d - large))), 0.0f);
  float less_axis = max(sin(0.5f * (small + (large - d))), 0.0f);
  float at_small = 2.0f * atan(sqrt(less_small * less_axis), sqrt(whole * less_large));
  float at_large = 2.0f * atan(sqrt(less_large * less_axis), sqrt(whole * less_small));
  float sectors = (at_small * cap_area(small) + at_large * cap_area(large)) / kPi;
  float area = sectors - twice_triangle_area(small, d, at_small);
  return clamp(area, 0.0f, cap_area(small));
}

ALCOVE_MATHS_END

#endif
