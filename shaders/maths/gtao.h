// Ground-truth ambient occlusion within a slice (Jimenez et al. 2016, ATVI-TR-16-01, section 4).
//
// The paper integrates visibility up to a horizon at angle h with J(h) = (-cos(2h - g) + cos g + 2
// h sin g) / 4, times the length of the projected normal. These functions compute the same integral
// without the angle g. With h the angle of the horizon to the view direction, at least 0 in both
// half-slices, c its cosine and s its sine, n the normal, v the view direction and d the direction
// of the slice, it is
//     length J = (s (s <n,v> - c <n,d>) + h <n,d>) / 2
// in the positive half-slice, and with -<n,d> in the negative one. It takes one square root and one
// arc cosine.
//
// Visibility is the sum of light_arc() over both halves of all slices, divided by the sum of
// open_slice(), or by the number of slices if there are many. A visibility of 1 is unoccluded.
#ifndef ALCOVE_MATHS_GTAO_H
#define ALCOVE_MATHS_GTAO_H

#include "arc_cosine.h"
#include "language.h"
#include "slice.h"

ALCOVE_MATHS_BEGIN

// Returns the cosine-weighted visibility of one half-slice between the view direction and a
// direction above the tangent plane, times the length of the projected normal. `light` has the sine
// (at least 0) and the cosine of the direction's angle. The error is at most 2.4e-5.
ALCOVE_INLINE float light_arc(Slice s, float side, vec2 light) {
  float swell = arc_cosine(light.y) - light.x * light.y;
  return 0.5f * (light.x * light.x * s.toward + swell * (side * s.along));
}

// Returns the visible part of a slice without occluders: length (cos gamma + gamma sin gamma). Its
// mean over uniformly spaced slices is exactly 1, so it serves as the weight of a slice.
ALCOVE_INLINE float open_slice(Slice s) { return s.toward + slice_gamma(s) * s.along; }

// Returns light_arc() of a half-slice up to the tangent plane. The sum of both is open_slice().
ALCOVE_INLINE float open_arc(Slice s, float side) {
  return light_arc(s, side, vec2(s.cosine, tangent_horizon(s, side)));
}

// Returns the share of a slice's directions, both of its halves weighted by the sine that solid
// angles have, between the view direction and a direction: (1 - cos h) / 2 ([Jimenez 2016],
// appendix A). The sum of both halves up to the tangent plane is 1.
ALCOVE_INLINE float uniform_arc(vec2 light) { return 0.5f - 0.5f * light.y; }

ALCOVE_MATHS_END

#endif
