#ifndef ALCOVE_RECONSTRUCT_PARAMETERS_H
#define ALCOVE_RECONSTRUCT_PARAMETERS_H

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

struct ReconstructParameters {
  // Areas for areas.h, read only with kAreas.
  ivec4 area;     // that is read: its position in the inputs (xy) and its size (zw)
  ivec4 written;  // the first pixel that is written (xy), and the last (zw)
  // Converts a position in this frame to a position in the previous frame. The position is (x, y,
  // 1, inverse depth) with x and y in pixels. The result is (x w, y w, w, depth) with x and y in
  // texels of the history, from the centre of the first one. In perspective its depth is divided by
  // the depth in this frame.
  mat4 previous_from_pixel;
  mat4 normal_from_view;  // rotation from view space to the space of the normals
  // Converts a normal in the space of the normals to the normal of its tangent plane in the space
  // of (x s, y s, depth): normal * mat3(plane_from_normal). x and y are in pixels; s is the depth
  // in perspective and 1 in orthographic views.
  mat4 plane_from_normal;
  mat4 previous_from_view;   // rotation from view space to that of the previous frame
  vec4 slope;                // xy: ray_per_px(); zw: of the ray at the image's corner; view space
  vec4 previous_extent;      // of the previous frame: xy the centre of its last texel, zw its size
                             // over this frame's size in pixels; in texels of the history
  vec4 history_depth_scale;  // of history_depth(): xy of this frame, zw of the previous frame, both
                             // for depths in history_unit
  vec4 traced_range;         // smallest and largest xy of a traced pixel, in pixels
  vec4 motion;               // from motion vectors to texels of the history: xy scale, zw offset
  vec2 history_texel;        // 1 over the size of the history's texture
  vec2 pixel_uv;             // 1 over the size of the depth buffer
  vec2 inverse_depth_from_ndc;  // of inverse_depth_of_ndc()
  vec2 pixels_per_slope;        // 1 over ray_per_px()
  ivec2 to_outputs;             // from pixels to the outputs, for areas.h
  ivec2 interleave_pixel;       // pixel of each tile that was traced this frame
  // 1 over the largest Window::sharpness: x at the centre of a texel of the history, and y what the
  // distance from centres adds per unit of History::between.
  vec2 smallest_window;
  float first_sharpness;  // Window::sharpness in a first frame
  float wide_sharpness;   // see Window::sharpness
  // The change of inverse depth, in scene units, for a change of 0.5 in the depth buffer.
  float half_inverse_depth_per_ndc;
  float depth_step;     // of the depth buffer, see depth_step()
  float largest_bend;   // of raw depth times depth, beyond which a plane needs the normal
  float history_slope;  // change of a stored depth, times history_sharpness, per Surface::slope
  float history_unit;   // a power of two near the near plane, in which the history holds depths,
                        // so that no unit of length changes a bit
  float tolerance;      // scale of distances from the tangent plane, in depths
  // 1 over the change of a stored depth at which a history texel's weight reaches 0, for a surface
  // seen head-on.
  float history_sharpness;
  float history_slack;   // rounding error of a stored depth, times history_sharpness
  float largest_weight;  // of the history, frames
  float roughness;       // perceptual, of every surface where no texture has it
  float power;           // of shaped_visibility()
  float intensity;       // of shaped_visibility()
  float dither_offset;   // [0,1), another one each frame
};

ALCOVE_MATHS_END

#endif
