#ifndef ALCOVE_RECONSTRUCT_PARAMETERS_H
#define ALCOVE_RECONSTRUCT_PARAMETERS_H

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

struct ReconstructParameters {
  // To the image of the frame before, from (x s, y s, depth, 1), x and y in pixels and s the depth
  // in perspective and 1 in orthographic views: x w and y w in pixels, the depth there, and w.
  mat4 previous_from_pixel;
  mat4 normal_from_view;  // rotation from view space to the space of the normals
  mat4 before_from_view;  // rotation from view space to that of the last frame
  vec4 slope;             // xy: ray_per_px(); zw: of the ray at the image's corner; view space
  // Of the frame before: xy its size in pixels, zw that in parts of this frame's.
  vec4 previous_size;
  vec4 history_depth;      // for held_depth(): xy of this frame, zw of the frame before
  vec4 motion;             // from motion vectors to pixels of the frame before: xy scale, zw offset
  vec2 interleave_offset;  // which pixel of each block was searched this frame
  float window_px;         // width of the window over one frame's searches
  float tolerance;         // scale of distances from the tangent plane, in depths
  float longest;           // frames that history counts at most
  float clamp_width;       // history is held to so many deviations of this frame's neighbourhood
  float roughness;         // perceptual, of every surface where no texture has it
  float power;             // of shaped_visibility(), as the next
  float intensity;
};

ALCOVE_MATHS_END

#endif
