// The image line of a slice, and depth samples on it as points of the slice's plane.
//
// A sample snapped to a texel's centre lies beside the line. If it is of the surface's own tangent
// plane its depth is moved onto the line along that plane (lies_on_tangent_plane), so it stays
// exactly open at any tilt and any snapping; the further it stands off the plane, the less of
// that. (The paper projects nothing; others use the sample as it is, and see a tilted plane occlude
// itself.)
//
// In the plane a point is (x, y): x along the slice's direction, y along the view direction, in
// scene units from the shaded point. Held as (x w, y w, w), w being 1/depth in perspective and 1 in
// orthographic views, it is linear in the distance along the line and in the sample's `line`: it
// costs three multiply-adds and no division, and no position in space is ever formed.
#ifndef ALCOVE_MATHS_SLICE_LINE_H
#define ALCOVE_MATHS_SLICE_LINE_H

#include "constants.h"
#include "language.h"
#include "projection.h"

ALCOVE_MATHS_BEGIN

// SliceSample::inverse_depth of the sky.
ALCOVE_INLINE float sky_inverse_depth(bool perspective) {
  return perspective ? 1.0f / kSkyDepth : kSkyDepth;
}

// Whether raw depth grows with SliceSample::inverse_depth.
ALCOVE_INLINE bool grows_with_inverse_depth(bool perspective, bool reversed) {
  return perspective == reversed;
}

// SliceSample::inverse_depth of a raw depth: from_ndc.x * d + from_ndc.y, where d is the distance
// of the raw depth from its value at the plane with the smallest inverse depth (the far plane in
// perspective, the near plane in orthographic views). This distance is exact, so that no digit that
// the depth buffer holds is lost. from_ndc.x must be positive, and in perspective from_ndc.y at
// least 0. The far plane, everything beyond it and NaN are the sky. Depths in front of the near
// plane give the near plane's.
ALCOVE_INLINE float inverse_depth_of_ndc(vec2 from_ndc, float depth_ndc, bool perspective,
                                         bool reversed) {
  bool grows = grows_with_inverse_depth(perspective, reversed);
  float from_smallest = clamp(grows ? depth_ndc : 1.0f - depth_ndc, 0.0f, 1.0f);
  bool sky = reversed ? !(depth_ndc > 0.0f) : !(depth_ndc < 1.0f);
  return sky ? sky_inverse_depth(perspective) : from_ndc.x * from_smallest + from_ndc.y;
}

// Whether a pixel's back face is where the occluder ends that begins at its front: it lies behind
// by more than depth buffers round, and is not the sky. Both as SliceSample::inverse_depth.
ALCOVE_INLINE bool ends_occluder(float front, float back, bool perspective) {
  float behind = perspective ? front - back : back - front;
  return behind > 1e-4f * abs(front) && back != sky_inverse_depth(perspective);
}

// The one of two values of SliceSample::inverse_depth that is further from the eye.
ALCOVE_INLINE float farther_inverse_depth(float a, float b, bool perspective) {
  return perspective ? min(a, b) : max(a, b);
}

struct SliceLine {
  vec2 direction_px;  // unit vector on the image, the way of positive x
  float x_per_step;   // x w of a point i pixels along direction_px: i * x_per_step; positive
  float y_per_step;   // y w of it: i * y_per_step + (centre depth - depth) w * y_per_depth
  float y_per_depth;  // length of the view ray at unit linear depth
};

// Change of the view ray's x and y from one pixel to the next.
ALCOVE_INLINE vec2 ray_per_px(Projection p) {
  return vec2((p.uv_to_slope.x + p.uv_to_origin.x) * p.texel_uv.x,
              (p.uv_to_slope.y + p.uv_to_origin.y) * p.texel_uv.y);
}

// The line of the slice through a point along `direction` (unit, perpendicular to `view`, which is
// unit, in view space); `per_px` is ray_per_px() of the projection.
ALCOVE_INLINE SliceLine make_slice_line(vec2 per_px, vec3 direction, vec3 view) {
  vec3 axis = cross(view, direction);
  // Image directions that stay in the plane have no component along its axis.
  vec2 along = vec2(per_px.y * axis.y, -per_px.x * axis.x);
  along = along * inversesqrt(max(dot(along, along), 1e-30f));
  float x_per_step = along.x * per_px.x * direction.x + along.y * per_px.y * direction.y;
  float y_per_step = along.x * per_px.x * view.x + along.y * per_px.y * view.y;
  bool turned = x_per_step < 0.0f;
  SliceLine slice_line;
  slice_line.direction_px = turned ? -along : along;
  slice_line.x_per_step = abs(x_per_step);
  slice_line.y_per_step = turned ? -y_per_step : y_per_step;
  slice_line.y_per_depth = 1.0f / max(view.z, 1e-6f);
  return slice_line;
}

// Returns (x w, y w, w) of the point that lies `offset_px` pixels along the line (negative: in the
// opposite direction) and has this SliceSample::inverse_depth. In the slice's plane, relative to
// the shaded point, x points along the line and y towards the eye; w is the inverse depth in
// perspective, else 1.
ALCOVE_INLINE vec3 slice_point(SliceLine slice_line, float offset_px, float inverse_depth,
                               float centre_depth, bool perspective) {
  float rise = perspective ? centre_depth * inverse_depth - 1.0f : centre_depth - inverse_depth;
  return vec3(offset_px * slice_line.x_per_step,
              offset_px * slice_line.y_per_step + rise * slice_line.y_per_depth,
              perspective ? inverse_depth : 1.0f);
}

// The surface's tangent plane on the image. SliceSample::inverse_depth, 1/depth in perspective and
// depth in orthographic views, is linear there.
struct TangentPlane {
  float inverse_depth;  // at the surface's own pixel
  vec2 gradient;        // for each pixel
  float fading;         // of a sample's correction with its distance from the plane
};

// `normal` and `view` are unit, in view space.
ALCOVE_INLINE TangentPlane make_tangent_plane(vec2 per_px, vec3 normal, vec3 view, float depth,
                                              bool perspective) {
  // Seen edge-on, the plane would run to any depth within a pixel.
  float n_dot_v = max(dot(normal, view), 0.01f);
  TangentPlane t;
  t.inverse_depth = perspective ? 1.0f / depth : depth;
  float rise = view.z / n_dot_v * (perspective ? -t.inverse_depth : 1.0f);
  t.gradient = vec2(per_px.x * normal.x * rise, per_px.y * normal.y * rise);
  t.fading = 60.0f * n_dot_v * n_dot_v / (abs(per_px.y) * (perspective ? t.inverse_depth : 1.0f));
  return t;
}

// The inverse of make_tangent_plane(): the unit normal, towards the eye, of a surface whose
// SliceSample::inverse_depth is `inverse_depth` at a pixel and changes by `gradient` for each
// pixel. `slope` is the view ray's x and y at unit depth there, which orthographic views do not
// have.
ALCOVE_INLINE vec3 normal_of_gradient(vec2 per_px, vec2 slope, float inverse_depth, vec2 gradient,
                                      bool perspective) {
  float scale = perspective ? -1.0f / inverse_depth : 1.0f;
  float x = gradient.x * scale / per_px.x;
  float y = gradient.y * scale / per_px.y;
  return normalize(vec3(x, y, perspective ? 1.0f + x * slope.x + y * slope.y : 1.0f));
}

// The step of a depth buffer as SliceSample::inverse_depth: the difference between neighbouring
// values that it can hold is at most constant + per_inverse_depth * inverse_depth.
struct DepthStep {
  float constant;
  float per_inverse_depth;
};

ALCOVE_INLINE float depth_step_at(DepthStep s, float inverse_depth) {
  return max(s.constant + s.per_inverse_depth * inverse_depth, 0.0f);
}

// How far a point that differs by `step` from one at `inverse_depth` lies before or behind it, in
// scene units.
ALCOVE_INLINE float depth_step_length(float step, float inverse_depth, bool perspective) {
  return perspective ? step / (inverse_depth * inverse_depth) : step;
}

// The fraction by which occlusion is faded to open because the depth buffer is too coarse: 0 if its
// step at the surface (`step_length`, scene units) is at most a quarter of the radius, 1 if it is
// at least the radius, linear in between.
ALCOVE_INLINE float unresolved_occlusion(float step_length, float radius) {
  return saturate((step_length / radius - 0.25f) * (4.0f / 3.0f));
}

// Whether a sample, `off_plane` off the tangent plane in inverse depth and so many pixels away, is
// taken to lie on that plane, and is moved along it to the exact place that it stands for. The
// plane itself then stays exactly flat, and an occluder stays where it was found.
ALCOVE_INLINE bool lies_on_tangent_plane(TangentPlane t, float off_plane, float offset_px) {
  return t.fading * abs(off_plane) < offset_px;
}

// Pixels along the line that a sphere of radius `radius` (scene units) around the point spans on
// one side. In perspective the sphere bulges towards the eye, and one around the eye spans
// everything: at most 1e30.
ALCOVE_INLINE float slice_radius_px(SliceLine slice_line, float radius, float centre_depth,
                                    bool perspective) {
  float across = radius / max((perspective ? centre_depth : 1.0f) * slice_line.x_per_step, 1e-30f);
  float nearness = perspective ? radius / max(centre_depth * slice_line.y_per_depth, 1e-30f) : 0.0f;
  return min(across * inversesqrt(max(1.0f - nearness * nearness, 1e-6f)), 1e30f);
}

ALCOVE_MATHS_END

#endif
