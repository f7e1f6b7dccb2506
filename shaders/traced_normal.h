// The normal of a pixel as the search uses it, and with which bent normals are finished. A shader
// that includes this file defines what areas.h needs, normal_image, kNormalEncoding, kPerspective
// and kReversed, and its parameters have the members `slope` and `inverse_depth_from_ndc`. With
// RECEIVERS it also defines kMask and receiver_image, which then has the depth of the surfaces.
#ifndef ALCOVE_TRACED_NORMAL_H
#define ALCOVE_TRACED_NORMAL_H

#include "depth_normal.h"
#include "maths/normal_encoding.h"

float inverse_depth_of(float depth_ndc) {
  return inverse_depth_of_ndc(parameters.inverse_depth_from_ndc, depth_ndc, kPerspective,
                              kReversed);
}

// Returns x and y, at unit depth, of the view ray through a point of the image, in pixels.
vec2 ray_slope(vec2 centre) {
  return parameters.slope.zw + (kPerspective ? centre * parameters.slope.xy : vec2(0.0));
}

// Returns the unit direction to the eye, in view space.
vec3 direction_to_eye(vec2 centre) { return normalize(vec3(-ray_slope(centre), 1.0)); }

// Returns the normal of the texture, in the space of the normals and with any length. It is 0 if
// there is no texture.
vec3 fetch_given_normal(ivec2 pixel) {
  return decode_normal(texelFetch(normal_image, in_inputs(pixel), 0).xyz, kNormalEncoding);
}

// Returns the unit normal from depth, in view space and towards the eye.
vec3 fetch_depth_normal(ivec2 pixel) {
  ivec2 origin = in_inputs(ivec2(0));
  DepthCross depths;
#ifdef RECEIVERS
  if (kMask)
    depths = fetch_depth_cross(receiver_image, pixel, origin, size_px());
  else
#endif
    depths = fetch_depth_cross(depth_image, pixel, origin, size_px());
  return depth_buffer_normal(depths, pixel, size_px(), parameters.slope,
                             parameters.inverse_depth_from_ndc, kPerspective, kReversed);
}

// Returns the unit normal in view space. `given` is the texture's in view space, and `view` the
// direction to the eye.
vec3 traced_normal(ivec2 pixel, vec3 given, vec3 view) {
  vec3 of_depth = vec3(0.0);
  if (needs_depth_normal(given, view)) of_depth = fetch_depth_normal(pixel);
  return seen_normal(given, view, of_depth);
}

#endif
