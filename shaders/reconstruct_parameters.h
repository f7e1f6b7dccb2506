#ifndef ALCOVE_RECONSTRUCT_PARAMETERS_H
#define ALCOVE_RECONSTRUCT_PARAMETERS_H

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

struct ReconstructParameters {
  // From (x, y, 1, 1/depth) in perspective or (x, y, depth, 1) in orthographic views, x and y in
  // pixels of this frame, to the previous frame: x w and y w in pixels there, w, and the depth
  // there (over the depth here in perspective). Rows, so that each is one dot product.
  mat4 previous_from_pixel;
  mat4 normal_from_view;  // rotation from view space to the space of the normals
  // A normal in the space of the normals times its upper 3x3 part is the normal of its tangent
  // plane in the space of (x s, y s, depth), x and y in pixels and s the depth in perspective, 1
  // otherwise.
  mat4 plane_from_normal;
  mat4 previous_from_view;   // rotation from view space to that of the previous frame
  vec4 slope;                // xy: ray_per_px(); zw: of the ray at the image's corner; view space
  vec4 previous_extent;      // of the previous frame: xy the centre of its last texel, in texels,
                             // zw its size in pixels as parts of this frame's
  vec4 history_depth_scale;  // of history_depth(): xy of this frame, zw of the previous frame, both
                             // for depths in history_unit
  vec4 traced_range;         // smallest and largest xy of a traced pixel, in pixels
  vec4 motion;         // from motion vectors to pixels of the previous frame: xy scale, zw offset
  vec2 history_texel;  // 1 over the size of the history's texture
  vec2 pixel_uv;       // 1 over the size of the depth buffer
  vec2 inverse_depth_from_ndc;  // of inverse_depth_of_ndc()
  vec2 pixels_per_slope;        // 1 over ray_per_px()
  vec2 interleave_offset;       // pixel of each tile that was traced this frame
  ivec2 interleave_pixel;       // the same in whole numbers
  // 0.125 / w^2 for the filter's window of w pixels in a first frame. A neighbour at a distance of
  // d pixels is weighted by 1 / (1 + inverse_squared_window d^2)^4.
  float inverse_squared_window;
  float history_unit;  // a power of two near the near plane, in which the history holds depths,
                       // so that no unit of length changes a bit
  float tolerance;     // scale of distances from the tangent plane, in depths
  float history_sharpness;  // of history_agreement(), for a surface seen head-on
  float history_slack;      // of history_agreement()
  float largest_weight;     // of the history, frames
  float clamp_width;        // of clamp_to_spread()
  float roughness;          // perceptual, of every surface where no texture has it
  float power;              // of shaped_visibility()
  float intensity;          // of shaped_visibility()
  float dither_offset;      // [0,1), another one each frame
};

ALCOVE_MATHS_END

#endif
