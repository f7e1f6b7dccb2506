// Converts raw depth to linear depth, and pixels to view-space positions, for every kind of
// projection.
//
// A Projection is made on the CPU (make_projection.h) from any Vulkan projection matrix: finite,
// infinite, reversed, off-centre, jittered, orthographic or flipped in Y. The same formulas,
// without branches, are valid for all of them.
//
// View space is right-handed with the camera along -Z. `depth` is linear: the distance along -Z in
// scene units, positive in front of the eye. The near plane of an orthographic view may lie behind
// the eye. `uv` is (0,0) at the top left corner of the image and (1,1) at the bottom right.
#ifndef ALCOVE_MATHS_PROJECTION_H
#define ALCOVE_MATHS_PROJECTION_H

#include "constants.h"
#include "language.h"

ALCOVE_MATHS_BEGIN

struct Projection {
  vec4 uv_to_slope;   // xy scale, zw offset: view-space xy per unit of depth along a pixel's ray
  vec4 uv_to_origin;  // xy scale, zw offset: view-space xy of a pixel's ray at depth 0
  // Coefficients that convert a view-space position to uv. The position has the coordinates xy and
  // the linear depth `depth`: uv = (position_to_uv.xy * xy + depth_to_uv.xy * depth +
  // position_to_uv.zw) / (depth_to_uv.z * depth + depth_to_uv.w). The divisor is positive.
  vec4 position_to_uv;
  vec4 depth_to_uv;
  vec4 depth_unproject;  // depth = (x * depth_ndc + y) / (z * depth_ndc + w)
  vec4 eye;              // vector from p to the eye: eye.xyz - eye.w * p (w is 0 in parallel views)
  vec2 size_px;          // size of the image
  vec2 texel_uv;         // 1 / size_px
  vec2 sky;              // depth_ndc is nearer than the far plane if x * depth_ndc < y
  vec2 near_far;         // linear depths of both planes; kSkyDepth if infinite
};

// Returns whether `depth_ndc`, a value of the depth buffer, is at or beyond the far plane, or NaN.
// Do not call it with filtered depth, which mixes the sky with the foreground.
ALCOVE_INLINE bool is_sky_ndc(Projection p, float depth_ndc) {
  return !(p.sky.x * depth_ndc < p.sky.y);
}

// Returns whether a result of linear_depth() is the sky. Do not call it with averaged depths.
ALCOVE_INLINE bool is_sky_depth(float depth) { return !(depth < kSkyDepth); }

// Returns the linear depth of `depth_ndc`, a value of the depth buffer. The sky, infinity and NaN
// give kSkyDepth. A value nearer than the near plane gives the depth of the near plane.
ALCOVE_INLINE float linear_depth(Projection p, float depth_ndc) {
  if (is_sky_ndc(p, depth_ndc)) return kSkyDepth;
  float d = min(max(depth_ndc, 0.0f), 1.0f);
  float divisor = p.depth_unproject.z * d + p.depth_unproject.w;
  return min((p.depth_unproject.x * d + p.depth_unproject.y) / max(divisor, 1e-30f), kSkyDepth);
}

ALCOVE_INLINE vec2 pixel_centre_uv(Projection p, uvec2 pixel) {
  return vec2((float(pixel.x) + 0.5f) * p.texel_uv.x, (float(pixel.y) + 0.5f) * p.texel_uv.y);
}

// Returns the view-space position of the point at `uv` with the linear depth `depth`.
ALCOVE_INLINE vec3 position_vs(Projection p, vec2 uv, float depth) {
  float slope_x = uv.x * p.uv_to_slope.x + p.uv_to_slope.z;
  float slope_y = uv.y * p.uv_to_slope.y + p.uv_to_slope.w;
  float origin_x = uv.x * p.uv_to_origin.x + p.uv_to_origin.z;
  float origin_y = uv.y * p.uv_to_origin.y + p.uv_to_origin.w;
  return vec3(slope_x * depth + origin_x, slope_y * depth + origin_y, -depth);
}

// Returns the view direction: the unit vector from a view-space position towards the eye. Its z is
// positive for positions in front of the eye.
ALCOVE_INLINE vec3 view_direction(Projection p, vec3 position) {
  return normalize(vec3(p.eye.x - p.eye.w * position.x, p.eye.y - p.eye.w * position.y,
                        p.eye.z - p.eye.w * position.z));
}

ALCOVE_MATHS_END

#endif
