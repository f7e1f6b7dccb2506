// The mean unoccluded direction, cosine-weighted, in closed form per slice.
//
// On one side of a slice, up to a horizon at angle h, with c and s its cosine and sine,
//     integral of (sin t, cos t) <n, w(t)> sin t dt
//       = ( <n,v> s^3 / 3           + <n,d> (2 - 3c + c^3) / 3,
//           <n,v> (1 - c^3) / 3     + <n,d> s^3 / 3 )
// where t is the angle from the view vector: no trigonometry at all. Not in the paper; it agrees
// with the closed forms published since.
#ifndef ALCOVE_MATHS_BENT_NORMAL_H
#define ALCOVE_MATHS_BENT_NORMAL_H

#include "language.h"
#include "slice.h"

ALCOVE_MATHS_BEGIN

// One side's part from the view vector to a light above the tangent plane: x along the slice's
// direction, y along the view vector, each at most 1 in size. `light` is the sine (at least 0) and
// cosine of its angle.
ALCOVE_INLINE vec2 bent_light_arc(Slice s, float side, vec2 light) {
  float along = side * s.along;
  float sine_cubed = light.x * light.x * light.x;
  float rise = 1.0f - light.y;
  float x = s.toward * sine_cubed + along * rise * rise * (2.0f + light.y);
  float y = s.toward * (1.0f - light.y * light.y * light.y) + along * sine_cubed;
  return vec2(side * x * (1.0f / 3.0f), y * (1.0f / 3.0f));
}

// The same up to a horizon, as horizon_light() takes it.
ALCOVE_INLINE vec2 bent_arc(Slice s, float side, float horizon) {
  return bent_light_arc(s, side, horizon_light(s, side, horizon));
}

// A slice's part of the bent normal, in the space of `direction` and `view`; sum over slices.
ALCOVE_INLINE vec3 slice_bent_normal(Slice s, vec3 direction, vec3 view, float ahead,
                                     float behind) {
  vec2 front = bent_arc(s, 1.0f, ahead);
  vec2 back = bent_arc(s, -1.0f, behind);
  return direction * (front.x + back.x) + view * (front.y + back.y);
}

// The residual of a slice: what its part of the bent normal, `part`, is beyond what so much
// visibility, `visible`, adds along the `normal` in the mean over open slices, whose sum is 2/3 of
// it. What filters and histories add up is the residual, so that a surface's own normal stays as
// sharp as it is. All in one space; the normal is unit. Each component at most 4/3 in size.
ALCOVE_INLINE vec3 residual_of(vec3 part, float visible, vec3 normal) {
  return part - normal * (visible * (2.0f / 3.0f));
}

// The residual of a slice if it is open, `open` of open_slice(). Its mean over all slices is zero;
// of few slices it is most of what they err by.
ALCOVE_INLINE vec3 expected_residual(Slice s, vec3 direction, vec3 view, vec3 normal, float open) {
  return residual_of(slice_bent_normal(s, direction, view, -1.0f, -1.0f), open, normal);
}

// A sum of bends, less as much of the slices' open bends, summed alike, as there is taken to be in
// it: the part of them that is visible, [0,1]. (A control variate: it changes no mean over all
// slices, and where all is open nothing is left.)
ALCOVE_INLINE vec3 converged_residual(vec3 residual, vec3 expected_residual, float visibility) {
  return residual - expected_residual * visibility;
}

// The unit bent normal of sums over slices, of their bends and of what is visible; `normal` where
// nothing is.
ALCOVE_INLINE vec3 finish_bent_normal(vec3 residual, float visible, vec3 normal) {
  vec3 sum = residual_of(residual, -visible, normal);
  float squared = dot(sum, sum);
  return squared > 1e-12f ? sum * inversesqrt(squared) : normal;
}

ALCOVE_MATHS_END

#endif
