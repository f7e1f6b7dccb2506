// The mean unoccluded direction, cosine-weighted, in closed form per slice.
//
// On one side of a slice, up to a horizon at angle h, with c and s its cosine and sine,
//     integral of (sin t, cos t) <n, w(t)> sin t dt
//       = ( <n,v> s^3 / 3           + <n,d> (2 - 3c + c^3) / 3,
//           <n,v> (1 - c^3) / 3     + <n,d> s^3 / 3 )
// where t is the angle from the view vector: no trigonometry at all. Not in the memo; it agrees
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

// The unit bent normal of a sum over slices; `normal` where nothing is visible.
ALCOVE_INLINE vec3 finish_bent_normal(vec3 sum, vec3 normal) {
  float squared = dot(sum, sum);
  return squared > 1e-12f ? sum * inversesqrt(squared) : normal;
}

ALCOVE_MATHS_END

#endif
