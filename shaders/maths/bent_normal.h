// The mean unoccluded direction, cosine-weighted, in closed form per slice.
//
// In one half-slice, up to a horizon at angle h with cosine c and sine s,
//     integral of (sin t, cos t) <n, w(t)> sin t dt
//       = ( <n,v> s^3 / 3           + <n,d> (2 - 3c + c^3) / 3,
//           <n,v> (1 - c^3) / 3     + <n,d> s^3 / 3 )
// where n is the normal, v the view direction, d the direction of the half-slice, t the angle from
// v and w(t) = d sin t + v cos t. It needs no trigonometric function, and it equals the formula in
// angles that the later edition of the paper [Jimenez 2016] gives as Algorithm 2.
#ifndef ALCOVE_MATHS_BENT_NORMAL_H
#define ALCOVE_MATHS_BENT_NORMAL_H

#include "language.h"
#include "slice.h"

ALCOVE_MATHS_BEGIN

// Returns the integral of the unoccluded direction over one half-slice, from the view direction to
// the direction `light`, which lies above the tangent plane and is given by the sine (at least 0)
// and the cosine of its angle. The result has x along the slice's direction and y along the view
// direction; each is at most 1 in size.
ALCOVE_INLINE vec2 bent_light_arc(Slice s, float side, vec2 light) {
  float along = side * s.along;
  float sine_cubed = light.x * light.x * light.x;
  float rise = 1.0f - light.y;
  float x = s.toward * sine_cubed + along * rise * rise * (2.0f + light.y);
  float y = s.toward * (1.0f - light.y * light.y * light.y) + along * sine_cubed;
  return vec2(side * x * (1.0f / 3.0f), y * (1.0f / 3.0f));
}

// Returns bent_light_arc() up to a horizon, which is given by its cosine as in horizon_light().
ALCOVE_INLINE vec2 bent_arc(Slice s, float side, float horizon) {
  return bent_light_arc(s, side, horizon_light(s, side, horizon));
}

// Returns a slice's contribution to the bent normal, in the space of `direction` and `view`.
// `ahead` and `behind` are the cosines of the horizons in the positive and the negative half-slice.
// The sum over all slices points along the bent normal.
ALCOVE_INLINE vec3 slice_bent_normal(Slice s, vec3 direction, vec3 view, float ahead,
                                     float behind) {
  vec2 front = bent_arc(s, 1.0f, ahead);
  vec2 back = bent_arc(s, -1.0f, behind);
  return direction * (front.x + back.x) + view * (front.y + back.y);
}

// Returns the residual of a slice: its contribution to the bent normal, `part`, minus the
// contribution that unoccluded slices with the same visibility `visible` have on average, which is
// 2/3 of it along `normal`. The filter and the history average residuals, so that the normal itself
// is never blurred. All vectors are in one space; `normal` is unit. Each component is at most 4/3
// in size.
ALCOVE_INLINE vec3 residual_of(vec3 part, float visible, vec3 normal) {
  return part - normal * (visible * (2.0f / 3.0f));
}

// Returns the residual of a slice without occluders; `open` is its open_slice(). Its mean over all
// slices is zero. With few slices their mean is not zero, and is most of the error of the sum of
// residuals.
ALCOVE_INLINE vec3 expected_residual(Slice s, vec3 direction, vec3 view, vec3 normal, float open) {
  return residual_of(slice_bent_normal(s, direction, view, -1.0f, -1.0f), open, normal);
}

// Returns a sum of residuals minus `visibility`, [0,1], times the same sum of expected residuals.
// The expected residual serves as a control variate: subtracting it does not change the mean over
// all slices, and makes the residual of an unoccluded surface zero.
ALCOVE_INLINE vec3 converged_residual(vec3 residual, vec3 expected_residual, float visibility) {
  return residual - expected_residual * visibility;
}

// Returns the unit bent normal. `residual` and `visible` are the sums of residuals and of visible
// parts over slices. If nothing is visible, returns `normal`.
ALCOVE_INLINE vec3 finish_bent_normal(vec3 residual, float visible, vec3 normal) {
  vec3 sum = residual_of(residual, -visible, normal);
  float squared = dot(sum, sum);
  return squared > 1e-12f ? sum * inversesqrt(squared) : normal;
}

ALCOVE_MATHS_END

#endif
