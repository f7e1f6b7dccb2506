// Slices: planes through the view direction, in which occluders are searched and visibility is
// integrated.
//
// A slice is spanned by the view direction v (unit, from the surface to the eye) and a unit
// direction d perpendicular to it. Angles in the slice are measured from v, positive towards d.
// `side` selects a half-slice: +1 towards d and -1 away from it. A horizon is given by the cosine
// of its angle to v, in either half-slice.
#ifndef ALCOVE_MATHS_SLICE_H
#define ALCOVE_MATHS_SLICE_H

#include "arc_cosine.h"
#include "constants.h"
#include "language.h"

ALCOVE_MATHS_BEGIN

// Two unit vectors that form a right-handed orthonormal basis with the view direction: (x, y,
// view). Both are continuous functions of the view direction if view.z > -1, which holds for every
// surface that the eye can see.
struct ViewBasis {
  vec3 x;
  vec3 y;
};

// Returns the basis for a unit view direction in view space (Frisvad 2012, for directions with z >
// -1).
ALCOVE_INLINE ViewBasis make_view_basis(vec3 view) {
  float a = -1.0f / (1.0f + max(view.z, -0.9999f));
  float b = view.x * view.y * a;
  ViewBasis basis;
  basis.x = vec3(1.0f + view.x * view.x * a, b, -view.x);
  basis.y = vec3(b, 1.0f + view.y * view.y * a, -view.y);
  return basis;
}

// Returns the direction of the slice at angle phi around the view direction. The interval [0,pi)
// contains every slice once, and [0,2pi) every half-slice once.
ALCOVE_INLINE vec3 slice_direction(ViewBasis basis, float phi) {
  float c = cos(phi);
  float s = sin(phi);
  return vec3(basis.x.x * c + basis.y.x * s, basis.x.y * c + basis.y.y * s,
              basis.x.z * c + basis.y.z * s);
}

// A normal in relation to a slice: the normal projected into the slice's plane, without normalising
// it. gamma is the signed angle from v to the projected normal, in [-pi/2,pi/2].
struct Slice {
  float along;   // <n,d> = scale * sin(gamma)
  float toward;  // <n,v> = scale * cos(gamma), at least 0
  float scale;   // length of the projected normal, [0,1]; 0 where it stands on the slice's plane
  float sine;    // sin(gamma)
  float cosine;  // cos(gamma); 1 where scale is 0
};

// Returns the normal in relation to the slice that `direction` and `view` span. All three vectors
// are unit and in one space; `direction` and `view` are perpendicular. A normal that points away
// from the eye is treated as perpendicular to the view direction. facing_normal() returns a normal
// that does not point away.
ALCOVE_INLINE Slice make_slice(vec3 normal, vec3 direction, vec3 view) {
  Slice s;
  s.along = dot(normal, direction);
  s.toward = max(dot(normal, view), 0.0f);
  float squared = s.along * s.along + s.toward * s.toward;
  float inverse = squared > 1e-12f ? inversesqrt(squared) : 0.0f;
  s.scale = squared * inverse;
  s.sine = s.along * inverse;
  s.cosine = inverse > 0.0f ? s.toward * inverse : 1.0f;
  return s;
}

// Returns gamma, the signed angle from the view direction to the projected normal, in [-pi/2,pi/2].
// It is computed from the smaller of its sine and cosine, because rounding then changes it least.
ALCOVE_INLINE float slice_gamma(Slice s) {
  bool steep = abs(s.sine) > s.cosine;
  float angle = arc_cosine(steep ? s.cosine : s.sine);
  return steep ? (s.sine < 0.0f ? -angle : angle) : kHalfPi - angle;
}

// If the cosine between a normal and the view direction is below minus this value, the normal is
// taken to be that of the other side of the surface. Interpolated and mapped normals near
// silhouettes seldom point that far away from the eye.
const float kFlippedNormal = 0.25f;

// Returns the normal of the side of the surface that the eye sees. It is `normal` if that faces the
// eye. It is the opposite of `normal` if the cosine of its angle to the view direction is below
// -kFlippedNormal, as with double-sided materials and inverted normals. In between it is the
// nearest direction that is perpendicular to the view direction. Both arguments are unit.
ALCOVE_INLINE vec3 facing_normal(vec3 normal, vec3 view) {
  float towards = dot(normal, view);
  vec3 side = towards < -kFlippedNormal ? -normal : normal;
  vec3 bent = side - view * min(dot(side, view), 0.0f);
  float squared = dot(bent, bent);
  return squared > 1e-8f ? bent * inversesqrt(squared) : view;
}

// Cosine of the angle of the tangent plane in a half-slice. It is the lowest possible horizon.
ALCOVE_INLINE float tangent_horizon(Slice s, float side) { return -side * s.sine; }

// Returns the sine (at least 0) and the cosine of the angle of a horizon. The horizon is given by
// its cosine, which is clamped to [tangent plane, 1].
ALCOVE_INLINE vec2 horizon_light(Slice s, float side, float horizon) {
  float c = clamp(horizon, tangent_horizon(s, side), 1.0f);
  return vec2(sqrt((1.0f - c) * (1.0f + c)), c);
}

ALCOVE_MATHS_END

#endif
