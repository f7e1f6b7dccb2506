// The image line of a slice, and depth samples near it as points of the slice's plane.
//
// A sample snapped to a texel's centre does not lie in the plane. It is carried there parallel to
// the surface's tangent plane, which keeps its height above that plane, so an open plane stays
// exactly open at any tilt and any snapping. (The memo projects nothing; others use the sample as
// it is, and see a tilted plane occlude itself.)
//
// Where the slice hardly meets the tangent plane the way is long and may end on the other side of
// the point: such a sample says nothing of its side and is to be passed over.
//
// In the plane a point is (x, y): x along the slice's direction, y along the view vector, in scene
// units from the shaded point. Both are linear in the texel offset (i, j) once it is scaled by s,
// the sample's linear depth in perspective and 1 in orthographic views, so a sample costs six
// multiply-adds and no position in space is ever formed.
#ifndef ALCOVE_MATHS_SLICE_LINE_H
#define ALCOVE_MATHS_SLICE_LINE_H

#include "language.h"
#include "projection.h"

ALCOVE_MATHS_BEGIN

struct SliceLine {
  vec2 direction_px;  // unit vector on the image, the way of positive x
  vec2 x_per_px;      // x of a point at offset (i, j): s * dot((i, j), x_per_px)
  vec2 y_per_px;      // y of it: s * dot((i, j), y_per_px) + (centre depth - depth) * y_per_depth
  float y_per_depth;  // length of the view ray at unit linear depth
  float x_per_step;   // x of the point one pixel along direction_px, for s = 1; positive
};

// Keeps the carry finite where a slice and the tangent plane do not meet at all and the slice
// weighs nothing.
const float kSmallestCarry = 1e-5f;

// Change of the view ray's x and y from one pixel to the next, to be scaled by s.
ALCOVE_INLINE vec2 ray_per_px(Projection p) {
  return vec2((p.uv_to_slope.x + p.uv_to_origin.x) * p.texel_uv.x,
              (p.uv_to_slope.y + p.uv_to_origin.y) * p.texel_uv.y);
}

// The factor s of a sample at linear depth `depth`.
ALCOVE_INLINE float sample_scale(Projection p, float depth) {
  return p.eye.w > 0.0f ? depth : 1.0f;
}

// The line of the slice through a point along `direction` (unit, perpendicular to `view`). `normal`
// and `view` are unit, in view space; `per_px` is ray_per_px() of the projection.
ALCOVE_INLINE SliceLine make_slice_line(vec2 per_px, vec3 normal, vec3 direction, vec3 view) {
  vec3 axis = cross(view, direction);
  float n_axis = dot(normal, axis);
  float carry = n_axis / max(1.0f - n_axis * n_axis, kSmallestCarry);
  vec3 to_x = direction + axis * (carry * dot(normal, direction));
  vec3 to_y = view + axis * (carry * dot(normal, view));

  SliceLine line;
  line.x_per_px = vec2(per_px.x * to_x.x, per_px.y * to_x.y);
  line.y_per_px = vec2(per_px.x * to_y.x, per_px.y * to_y.y);
  line.y_per_depth = 1.0f / max(view.z, 1e-6f);
  // Image directions that stay in the plane have no component along its axis.
  vec2 along = vec2(per_px.y * axis.y, -per_px.x * axis.x);
  along = along * inversesqrt(max(dot(along, along), 1e-30f));
  float x_per_step = dot(along, line.x_per_px);
  line.direction_px = x_per_step < 0.0f ? -along : along;
  line.x_per_step = abs(x_per_step);
  return line;
}

// The sample at a texel offset and a linear depth as a point of the plane; `scale` is
// sample_scale() of its depth.
ALCOVE_INLINE vec2 slice_point(SliceLine line, vec2 offset_px, float depth, float centre_depth,
                               float scale) {
  return vec2(scale * dot(offset_px, line.x_per_px),
              scale * dot(offset_px, line.y_per_px) + (centre_depth - depth) * line.y_per_depth);
}

// Pixels along the line that a sphere of radius `radius` (scene units) around the point spans on
// one side. In perspective the sphere bulges towards the eye, and one around the eye spans
// everything.
ALCOVE_INLINE float slice_radius_px(Projection p, SliceLine line, float radius,
                                    float centre_depth) {
  float across = radius / max(sample_scale(p, centre_depth) * line.x_per_step, 1e-30f);
  float nearness = p.eye.w * radius / max(centre_depth * line.y_per_depth, 1e-30f);
  return across * inversesqrt(max(1.0f - nearness * nearness, 1e-6f));
}

ALCOVE_MATHS_END

#endif
