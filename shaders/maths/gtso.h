// Specular occlusion from visibility and bent normal ([Jimenez 2016], section 6: GTSO).
//
// The visible directions are approximated by a cone around the bent normal. The specular visibility
// is the fraction of the GGX lobe within that cone (gtso_table.h); 1 is open. All vectors are unit.
#ifndef ALCOVE_MATHS_GTSO_H
#define ALCOVE_MATHS_GTSO_H

#include "language.h"

ALCOVE_MATHS_BEGIN

// Returns the visibility that the cones are computed from, [0,1]: values above 127/128 become 1,
// and smaller ones are scaled by the same factor, because a filtered visibility is not more
// accurate than that. The half-angle of the visibility cone has the cosine sqrt(1 - visibility), so
// an error of 1/128 on an open surface narrows the cone by 5 degrees. At grazing angles that would
// remove all of a narrow specular lobe.
ALCOVE_INLINE float converged_visibility(float visibility) {
  return saturate(visibility * (128.0f / 127.0f));
}

// Returns the mirror direction of `view`. A view direction below the surface, which interpolated
// normals can cause, is first moved onto the surface.
ALCOVE_INLINE vec3 mirror_direction(vec3 normal, vec3 view) {
  float n_dot_v = dot(normal, view);
  vec3 facing = n_dot_v < 1e-3f ? normalize(view + (1e-3f - n_dot_v) * normal) : view;
  return 2.0f * dot(normal, facing) * normal - facing;
}

// Returns the angle, [0,pi], from the square of its sine and from its cosine. Both may be
// multiplied by a common factor (the square by the factor's square). A square that is negative
// because of rounding counts as 0.
ALCOVE_INLINE float angle_of(float sine_squared, float cosine) {
  return atan(sqrt(max(sine_squared, 0.0f)), cosine);
}

// Returns the angle between two unit vectors, [0,pi]. Unlike acos(dot(a, b)) it is accurate near 0
// and pi.
ALCOVE_INLINE float angle_between(vec3 a, vec3 b) {
  vec3 normal = cross(a, b);
  return atan(sqrt(dot(normal, normal)), dot(a, b));
}

// Returns the half-angle of the cone around the normal that has this cosine-weighted visibility.
ALCOVE_INLINE float visibility_cone(float visibility) {
  float v = clamp(visibility, 0.0f, 1.0f);
  return angle_of(v, sqrt(1.0f - v));
}

// Returns the bent normal, rotated towards the normal until the visibility cone around it lies
// above the surface. If the surface is unoccluded, the cone is the hemisphere, and the result is
// the normal itself without the noise of the bent normal.
ALCOVE_INLINE vec3 raised_bent_normal(vec3 bent_normal, vec3 normal, float visibility) {
  float v = clamp(visibility, 0.0f, 1.0f);
  float bent_dot_normal = dot(bent_normal, normal);
  if (bent_dot_normal * abs(bent_dot_normal) >= v) return bent_normal;
  vec3 across = bent_normal - bent_dot_normal * normal;
  float squared = dot(across, across);
  if (squared < 1e-12f) return normal;
  return sqrt(v) * normal + sqrt((1.0f - v) / squared) * across;
}

ALCOVE_MATHS_END

#endif
