// What a neighbouring pixel weighs in a filter that must not cross edges. All weights are in [0,1].
#ifndef ALCOVE_MATHS_FILTER_WEIGHTS_H
#define ALCOVE_MATHS_FILTER_WEIGHTS_H

#include "language.h"

ALCOVE_MATHS_BEGIN

// By the distance of the neighbour from the tangent plane of the centre, `normal` at `centre`: 1 on
// the plane, 0 from `tolerance` (a length, positive) on. A plane at any tilt weighs 1 throughout,
// where a weight on the difference of depth alone would cut it. Cubic smoothing: no kink at either.
ALCOVE_INLINE float plane_weight(vec3 centre, vec3 normal, vec3 neighbour, float tolerance) {
  float distance_to_plane = abs(dot(neighbour - centre, normal));
  float t = clamp(1.0f - distance_to_plane / tolerance, 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

// By depth against what the slope at the centre predicts: `expected` is the centre's depth plus
// slope times offset. The same shape, where positions and normals are not at hand.
ALCOVE_INLINE float slope_weight(float depth, float expected, float tolerance) {
  float t = clamp(1.0f - abs(depth - expected) / tolerance, 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

// The slope of depth along one axis, per pixel, of three neighbouring depths: the smaller of the
// two differences, since the larger crosses an edge if one of them does.
ALCOVE_INLINE float depth_slope(float before, float centre, float after) {
  float left = centre - before;
  float right = after - centre;
  return abs(left) < abs(right) ? left : right;
}

// By the angle between two unit normals: 1 where they agree, 0 from the angle on whose cosine is
// `limit` (below 1).
ALCOVE_INLINE float normal_weight(vec3 normal, vec3 neighbour, float limit) {
  return clamp((dot(normal, neighbour) - limit) / (1.0f - limit), 0.0f, 1.0f);
}

// How much a filter should still smooth a pixel that already holds `held` directions when `enough`
// would do: 1 for a first direction, 0 for a converged one.
ALCOVE_INLINE float filter_strength(float held, float enough) {
  return clamp((enough - held) / max(enough - 1.0f, 1.0f), 0.0f, 1.0f);
}

ALCOVE_MATHS_END

#endif
