// Raw depth to linear depth, pixels to view-space positions and back, for every projection.
//
// A Projection is made on the CPU (make_projection.h) from any Vulkan projection matrix: finite,
// infinite, reversed, off-centre, jittered, orthographic, flipped in Y. One set of formulas, with
// no branch on the kind, then serves them all.
//
// View space is right-handed with the camera along -Z. `depth` is linear: the distance along -Z in
// the scene's units (positive in front of the eye; an orthographic near plane may lie behind it).
// `uv` is (0,0) at the top left corner of the image and (1,1) at the bottom right.
#ifndef ALCOVE_MATHS_PROJECTION_H
#define ALCOVE_MATHS_PROJECTION_H

#include "constants.h"
#include "language.h"

ALCOVE_MATHS_BEGIN

struct Projection {
  vec4 uv_to_slope;      // xy scale, zw offset: view-space xy per unit of depth along a pixel's ray
  vec4 uv_to_origin;     // xy scale, zw offset: view-space xy where a pixel's ray meets depth 0
  vec4 position_to_uv;   // xy scale of view-space xy, zw constant; the sum is divided by w
  vec4 depth_to_uv;      // xy coefficient of depth in the same sum; w = z * depth + w
  vec4 depth_unproject;  // depth = (x * depth_ndc + y) / (z * depth_ndc + w)
  vec4 eye;              // to the eye from p: eye.xyz - eye.w * p (w is 0 where rays are parallel)
  vec2 size_px;          // of the image
  vec2 texel_uv;         // 1 / size_px
  vec2 sky;              // depth_ndc is the far plane's unless x * depth_ndc < y
  vec2 near_far;         // linear; far is kSkyDepth when infinite
};

// Whether raw depth is the far plane's or beyond it, or not a number. Ask it of raw depth only: a
// filtered depth mixes the sky with what stands before it.
ALCOVE_INLINE bool is_sky_ndc(Projection p, float depth_ndc) {
  return !(p.sky.x * depth_ndc < p.sky.y);
}

// The same question of a linear depth that linear_depth() returned and nothing averaged.
ALCOVE_INLINE bool is_sky_depth(float depth) { return !(depth < kSkyDepth); }

// Linear depth of a raw one. The sky, infinity and what is not a number come out as kSkyDepth; a
// value on the wrong side of the near plane as the near plane's.
ALCOVE_INLINE float linear_depth(Projection p, float depth_ndc) {
  if (is_sky_ndc(p, depth_ndc)) return kSkyDepth;
  float d = min(max(depth_ndc, 0.0f), 1.0f);
  float divisor = p.depth_unproject.z * d + p.depth_unproject.w;
  return min((p.depth_unproject.x * d + p.depth_unproject.y) / max(divisor, 1e-30f), kSkyDepth);
}

// Raw depth of a linear one, not clamped: beyond [0,1] outside the near and far planes.
ALCOVE_INLINE float ndc_depth(Projection p, float depth) {
  return (p.depth_unproject.y - depth * p.depth_unproject.w) /
         (depth * p.depth_unproject.z - p.depth_unproject.x);
}

ALCOVE_INLINE vec2 pixel_centre_uv(Projection p, uvec2 pixel) {
  return vec2((float(pixel.x) + 0.5f) * p.texel_uv.x, (float(pixel.y) + 0.5f) * p.texel_uv.y);
}

// View-space position of the point at `uv` whose linear depth is `depth`.
ALCOVE_INLINE vec3 position_vs(Projection p, vec2 uv, float depth) {
  float slope_x = uv.x * p.uv_to_slope.x + p.uv_to_slope.z;
  float slope_y = uv.y * p.uv_to_slope.y + p.uv_to_slope.w;
  float origin_x = uv.x * p.uv_to_origin.x + p.uv_to_origin.z;
  float origin_y = uv.y * p.uv_to_origin.y + p.uv_to_origin.w;
  return vec3(slope_x * depth + origin_x, slope_y * depth + origin_y, -depth);
}

// The divisor of the projection at a linear depth: at most 0 for a perspective's eye and behind it.
ALCOVE_INLINE float clip_w(Projection p, float depth) {
  return p.depth_to_uv.z * depth + p.depth_to_uv.w;
}

// Where a view-space position falls on the image. Meaningless where clip_w(p, -position.z) <= 0.
ALCOVE_INLINE vec2 uv_of_position(Projection p, vec3 position) {
  float depth = -position.z;
  float scale = 1.0f / clip_w(p, depth);
  float x = position.x * p.position_to_uv.x + depth * p.depth_to_uv.x + p.position_to_uv.z;
  float y = position.y * p.position_to_uv.y + depth * p.depth_to_uv.y + p.position_to_uv.w;
  return vec2(x * scale, y * scale);
}

// Unit vector from a view-space position towards the eye, against the ray that sees it. Its z is
// positive for whatever lies before the eye.
ALCOVE_INLINE vec3 view_vector(Projection p, vec3 position) {
  return normalize(vec3(p.eye.x - p.eye.w * position.x, p.eye.y - p.eye.w * position.y,
                        p.eye.z - p.eye.w * position.z));
}

// Pixels that a unit of length in the image plane's x and y covers at a linear depth; positive.
ALCOVE_INLINE vec2 pixels_per_unit(Projection p, float depth) {
  float scale = 1.0f / max(clip_w(p, depth), 1e-30f);
  return vec2(abs(p.position_to_uv.x) * p.size_px.x * scale,
              abs(p.position_to_uv.y) * p.size_px.y * scale);
}

// Pixels, signed, that the image of a point at `depth` moves per unit of travel along `direction`,
// a vector perpendicular to the view vector `view` there. Direction and view span a plane through
// the eye, so its whole image is the one line along the result.
ALCOVE_INLINE vec2 pixels_along(Projection p, vec3 direction, vec3 view, float depth) {
  // Sliding the direction along the ray into the image plane moves no pixel.
  float slide = direction.z / max(view.z, 1e-6f);
  float scale = 1.0f / max(clip_w(p, depth), 1e-30f);
  return vec2((direction.x - slide * view.x) * p.position_to_uv.x * p.size_px.x * scale,
              (direction.y - slide * view.y) * p.position_to_uv.y * p.size_px.y * scale);
}

ALCOVE_MATHS_END

#endif
