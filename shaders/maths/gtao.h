// Ground-truth ambient occlusion within a slice (Jimenez et al. 2016, ATVI-TR-16-01, section 4).
//
// The paper's arc J(h) = (-cos(2h - g) + cos g + 2 h sin g) / 4, times the length of the projected
// normal, is written here in the cosine of the horizon and the components of the normal: with c and
// s the cosine and sine of the horizon and h its angle, each positive,
//     length J = (s (s <n,v> - c <n,d>) + h <n,d>) / 2
// on the positive side, and with -<n,d> on the negative. One square root and one arc cosine are all
// the transcendentals, and gamma itself is never needed.
//
// Visibility: 1 is open. A = sum over slices of slice_visibility() / sum of open_slice(), or over
// the number of slices where they are many.
#ifndef ALCOVE_MATHS_GTAO_H
#define ALCOVE_MATHS_GTAO_H

#include "arc_cosine.h"
#include "language.h"
#include "slice.h"

ALCOVE_MATHS_BEGIN

// Cosine-weighted visibility of one side from the view vector to a light above the tangent plane,
// times the projected normal's length. `light` is the sine (at least 0) and cosine of its angle.
// Within 2.4e-5.
ALCOVE_INLINE float light_arc(Slice s, float side, vec2 light) {
  float swell = arc_cosine(light.y) - light.x * light.y;
  return 0.5f * (light.x * light.x * s.toward + swell * (side * s.along));
}

// The same up to a horizon, as horizon_light() takes it.
ALCOVE_INLINE float slice_arc(Slice s, float side, float horizon) {
  return light_arc(s, side, horizon_light(s, side, horizon));
}

// Both sides together: the slice's part of the visibility. `ahead` is the horizon's cosine on the
// positive side, `behind` on the negative. In [0, open_slice(s)], at most 1.571.
ALCOVE_INLINE float slice_visibility(Slice s, float ahead, float behind) {
  return max(slice_arc(s, 1.0f, ahead) + slice_arc(s, -1.0f, behind), 0.0f);
}

// The slice's visibility with nothing in it: length (cos gamma + gamma sin gamma). Its mean over
// uniformly spaced slices is exactly 1, so it is both what a slice weighs and what normalises them.
ALCOVE_INLINE float open_slice(Slice s) { return s.toward + slice_gamma(s) * s.along; }

// light_arc() of both half-slices up to the tangent plane, x ahead and y behind, with one arc
// cosine. Their sum is open_slice().
ALCOVE_INLINE vec2 tangent_arcs(Slice s) {
  float level = s.cosine * s.cosine * s.toward;
  float swell = arc_cosine(-s.sine) + s.sine * s.cosine;
  return vec2(0.5f * (level + swell * s.along), 0.5f * (level - (kPi - swell) * s.along));
}

// Visibility of one side without the cosine of the normal (the paper's appendix A), from the view
// vector to a light above the tangent plane; both sides of an open slice come to 1, at any tilt.
ALCOVE_INLINE float uniform_arc(vec2 light) { return 0.5f * (1.0f - light.y); }

// The same of both sides up to their horizons, in [0,1]: averaged over slices, the part of the
// hemisphere's solid angle that is visible.
ALCOVE_INLINE float uniform_slice_visibility(Slice s, float ahead, float behind) {
  float ahead_cut = clamp(ahead, tangent_horizon(s, 1.0f), 1.0f);
  float behind_cut = clamp(behind, tangent_horizon(s, -1.0f), 1.0f);
  return 1.0f - 0.5f * (ahead_cut + behind_cut);
}

// The paper's heuristic for occluders of unknown thickness: a sample above the horizon replaces it,
// one below pulls it down by `blend` (0: infinitely thick; 0.05 is already much). Cosines.
ALCOVE_INLINE float raise_horizon(float horizon, float found, float blend) {
  return found > horizon ? found : mix(horizon, found, blend);
}

// What an occluder weighs at a distance, [0,1]: all up to the last part `falloff`, [0,1], of the
// radius, over which it fades; none beyond the radius. A falloff of 0 is a step.
ALCOVE_INLINE float radius_weight(float distance, float radius, float falloff) {
  float left = radius - distance;
  return left < 0.0f ? 0.0f : min(left / max(falloff * radius, 1e-30f), 1.0f);
}

ALCOVE_MATHS_END

#endif
