// The line in which a slice appears on the image, and the positions of depth samples in the slice.
//
// A slice is a plane that contains the view direction, so it appears on the image as a straight
// line through the shaded pixel. Depth samples are taken along this line. Each sample becomes a
// point (x, y) of the slice's plane, in scene units relative to the shaded point: x along the
// slice's direction, y along the view direction towards the eye.
//
// Depths are stored as *inverse depth*: 1/z in perspective, linear depth z in orthographic views.
// Inverse depth is linear along the image of any plane. Points are stored as (x w, y w, w), where w
// is the inverse depth in perspective and 1 in orthographic views. These three numbers are linear
// in the distance on the image and in the inverse depth, so a sample costs three multiply-adds and
// no division. Angles need only the ratio of x and y, from which w cancels.
//
// A sample that is snapped to the centre of a texel lies beside the line. Its depth is then that of
// a place up to 0.7 pixels away, so that a tilted plane would occlude itself. If the sample lies on
// the tangent plane of the shaded point (lies_on_tangent_plane), its depth is therefore moved along
// that plane from the texel's centre to the line. Samples off the plane keep their depth.
#ifndef ALCOVE_MATHS_SLICE_LINE_H
#define ALCOVE_MATHS_SLICE_LINE_H

#include "constants.h"
#include "language.h"

ALCOVE_MATHS_BEGIN

// The inverse depth that stands for the sky, where no surface is drawn.
ALCOVE_INLINE float sky_inverse_depth(bool perspective) {
  return perspective ? 1.0f / kSkyDepth : kSkyDepth;
}

// Whether inverse depth is computed from the value in the depth buffer. If not, it is computed from
// 1 minus that value, because most values of a perspective view are then close to 1.
ALCOVE_INLINE bool is_counted_from_zero(bool perspective, bool reversed) {
  return !perspective || reversed;
}

// Whether a value of the depth buffer is the sky's: the far plane, beyond it or NaN.
ALCOVE_INLINE bool is_sky_ndc(float depth_ndc, bool reversed) {
  return reversed ? !(depth_ndc > 0.0f) : !(depth_ndc < 1.0f);
}

// Converts a value of the depth buffer to inverse depth: from_ndc.x * d + from_ndc.y, where d is
// `depth_ndc` or 1 minus that, whichever has the digits of the depth buffer without rounding
// (is_counted_from_zero()). In perspective from_ndc must not be negative. The far plane, everything
// beyond it and NaN give the sky. Depths in front of the near plane give the inverse depth of the
// near plane.
ALCOVE_INLINE float inverse_depth_of_ndc(vec2 from_ndc, float depth_ndc, bool perspective,
                                         bool reversed) {
  float d =
      clamp(is_counted_from_zero(perspective, reversed) ? depth_ndc : 1.0f - depth_ndc, 0.0f, 1.0f);
  return is_sky_ndc(depth_ndc, reversed) ? sky_inverse_depth(perspective)
                                         : from_ndc.x * d + from_ndc.y;
}

// Whether the back face at a pixel can be the end of the occluder whose front face is at that
// pixel. The back face must lie behind the front face by more than the rounding of depth buffers,
// and must not be the sky. Both arguments are inverse depths.
ALCOVE_INLINE bool ends_occluder(float front, float back, bool perspective) {
  float behind = perspective ? front - back : back - front;
  return behind > 1e-4f * abs(front) && back != sky_inverse_depth(perspective);
}

// Returns the one of two inverse depths that is farther from the eye.
ALCOVE_INLINE float farther_inverse_depth(float a, float b, bool perspective) {
  return perspective ? min(a, b) : max(a, b);
}

// The coefficients that turn a distance on the image and a depth into a point (x w, y w, w) of the
// slice's plane: x w = px x_per_step and y w = px y_per_step + rise y_per_depth, where px is the
// distance in pixels. With d the linear depth of the shaded point, and i the inverse depth of the
// other point, rise is d i - 1 in perspective and d - i in orthographic views.
struct SliceLine {
  vec2 direction_px;  // unit vector on the image, towards positive x of the slice's plane
  float x_per_step;   // change of x w per pixel along direction_px; positive
  float y_per_step;   // change of y w per pixel along direction_px at constant depth
  float y_per_depth;  // change of y per scene unit of linear depth towards the eye
};

// Returns the line of the slice that is spanned by `view`, the unit view direction at the shaded
// point, and `direction`, a unit vector perpendicular to it. Both are in view space. `per_px` is
// ray_per_px() of the projection.
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

// The tangent plane of the shaded point, as a linear function of the position on the image.
struct TangentPlane {
  float inverse_depth;  // at the shaded pixel
  vec2 gradient;        // change of the inverse depth per pixel in x and y of the image
  float fading;         // pixels of distance from the shaded pixel that a sample needs per unit of
                        // inverse depth off the plane, to count as lying on it
};

// `normal` and `view` (the direction towards the eye) are unit vectors in view space, `depth` is
// the linear depth of the shaded point, and `per_px` is ray_per_px() of the projection.
ALCOVE_INLINE TangentPlane make_tangent_plane(vec2 per_px, vec3 normal, vec3 view, float depth,
                                              bool perspective) {
  // The lower limit keeps the gradient finite if the plane is seen edge-on.
  float n_dot_v = max(dot(normal, view), 0.01f);
  TangentPlane t;
  t.inverse_depth = perspective ? 1.0f / depth : depth;
  float rise = view.z / n_dot_v * (perspective ? -t.inverse_depth : 1.0f);
  t.gradient = vec2(per_px.x * normal.x * rise, per_px.y * normal.y * rise);
  t.fading = 60.0f * n_dot_v * n_dot_v / (abs(per_px.y) * (perspective ? t.inverse_depth : 1.0f));
  return t;
}

// The inverse of make_tangent_plane(). Returns the unit normal, towards the eye and in view space,
// of a surface that has the given inverse depth at a pixel and whose inverse depth changes by
// `gradient` per pixel. `slope` is x and y of the pixel's view ray at unit depth; it is not used in
// orthographic views.
ALCOVE_INLINE vec3 normal_of_gradient(vec2 per_px, vec2 slope, float inverse_depth, vec2 gradient,
                                      bool perspective) {
  float scale = perspective ? -1.0f / inverse_depth : 1.0f;
  float x = gradient.x * scale / per_px.x;
  float y = gradient.y * scale / per_px.y;
  return normalize(vec3(x, y, perspective ? 1.0f + x * slope.x + y * slope.y : 1.0f));
}

// The precision of a depth buffer, converted to inverse depth: two neighbouring values that the
// buffer can hold differ by at most constant + per_inverse_depth * inverse_depth.
struct DepthStep {
  float constant;
  float per_inverse_depth;
};

ALCOVE_INLINE float depth_step_at(DepthStep s, float inverse_depth) {
  return max(s.constant + s.per_inverse_depth * inverse_depth, 0.0f);
}

// The fraction by which occlusion is faded to open because the depth buffer is too coarse: 0 if its
// step at the surface (`step_length`, scene units) is at most a quarter of the radius (chosen), 1
// if it is at least the radius, linear in between.
ALCOVE_INLINE float unresolved_occlusion(float step_length, float radius) {
  return saturate((step_length / radius - 0.25f) * (4.0f / 3.0f));
}

// Whether a sample is treated as lying on the tangent plane. `off_plane` is its distance from the
// plane and `offset` its distance from the shaded pixel. `fading` is TangentPlane::fading if these
// are an inverse depth and pixels. The tolerance grows with the distance: a slope of 1 / (60
// (n.v)^2) relative to the plane, where n.v is the cosine between the normal and the view
// direction.
ALCOVE_INLINE bool lies_on_tangent_plane(float fading, float off_plane, float offset) {
  return fading * abs(off_plane) < offset;
}

// Returns x w, in units of the radius, of the farthest point along the line, on one side, that the
// sphere with this radius (scene units) around the shaded point covers. `inverse_depth` is that of
// the shaded point. In perspective the part of the sphere that is nearer to the eye covers more
// than a disc of the radius would. If the eye lies within the sphere, the result is 1000 times that
// of a disc.
ALCOVE_INLINE float sphere_reach(SliceLine slice_line, float radius, float inverse_depth,
                                 bool perspective) {
  float nearness = perspective ? radius * (inverse_depth / slice_line.y_per_depth) : 0.0f;
  return (perspective ? inverse_depth : 1.0f) * inversesqrt(max(1.0f - nearness * nearness, 1e-6f));
}

ALCOVE_MATHS_END

#endif
