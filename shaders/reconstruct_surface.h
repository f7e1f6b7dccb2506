// The place and the surface of a texel, which reconstruct.comp and reconstruct_half.comp fetch.
#ifndef ALCOVE_RECONSTRUCT_SURFACE_H
#define ALCOVE_RECONSTRUCT_SURFACE_H

#include "maths/raw_occlusion.h"
#include "reconstruct_bindings.h"
#include "reconstruct_tiles.h"
#include "traced_normal.h"
#ifdef SPECULAR
#include "fetch_roughness.h"
#endif

// Lower bound of the cosine between the normal and the view direction. Without it, the tangent
// plane of a surface that is seen edge-on would contain points at every depth.
const float kLeastNDotV = 0.02;

// The place of a texel, and values that depend on it alone. From block to block of a column each of
// them changes by a constant.
struct Place {
  ivec2 texel;  // at which results are stored
  vec2 centre;  // pixels
  vec2 uv;      // of the upper left corner, on the depth buffer
  TracedPixels around;
  vec4 previous;  // of an inverse depth of 0, after ReconstructParameters::previous_from_pixel
  float dither;   // for dither_of()
};

// Change of Place::dither from one pixel to the next [Jimenez 2014, interleaved gradient noise].
const vec2 kDitherGradient = vec2(0.06711056, 0.00583715);

Place first_place() {
  Place place;
  place.texel = first_texel() + ivec2(gl_LocalInvocationID.xy);
  place.centre = (vec2(place.texel) + 0.5) * float(kTexelSize);
  place.uv = vec2(place.texel * kTexelSize) * parameters.pixel_uv;
  place.around = find_traced(place.texel * kTexelSize);
  mat4 from_pixel = parameters.previous_from_pixel;
  place.previous = from_pixel[0] * place.centre.x + from_pixel[1] * place.centre.y + from_pixel[2];
  place.dither = dot(place.centre, kDitherGradient) + parameters.dither_offset;
  return place;
}

void move_to_next_block(inout Place place) {
  const float rows = float(kGroupPixels);
  place.texel.y += 8;
  place.centre.y += rows;
  place.uv.y += rows * parameters.pixel_uv.y;
  place.around.first_tile += kGroupPixels / kTileSize * kSpan;
  place.previous += parameters.previous_from_pixel[1] * rows;
  place.dither += rows * kDitherGradient.y;
}

// A pixel's surface, or that of a texel at half resolution.
struct Surface {
  Place place;
  bool sky;
  ivec2 pixel;          // at which its inputs are read
  float inverse_depth;  // 1/depth in perspective, depth otherwise: linear along any plane's image
  float depth;          // 1/inverse_depth in perspective, 1 otherwise
  float n_dot_v;        // cosine between normal and view direction, on the camera's axis
  // In perspective the relative change of 1/depth per pixel along the tangent plane, in
  // orthographic views the change of the depth, both times n_dot_v.
  vec2 slope;
  vec3 stereographic;  // (x, y, 1 + z) of the unit normal in view space, for squared_angle()
  LobeSurface lobe;    // normal as it was given
  vec2 tilt;           // HalfTexel::tilt; only with HALF
  // Coefficients of the distance of a neighbour from the tangent plane, in units of the tolerance:
  // its inverse depth times per_inverse_depth, minus plane.xy times its offset in pixels, minus
  // plane.z. They are set by set_plane().
  float per_inverse_depth;
  vec3 plane;
};

// Returns the cosine between normal and view direction, on the camera's axis, for a
// HalfTexel::tilt.
float n_dot_v_of(vec2 tilt, vec2 centre) {
  float z = 1.0 + dot(tilt, ray_slope(centre));
  return inversesqrt(dot(tilt, tilt) + z * z);
}

void set_plane(inout Surface surface) {
  float per_distance = surface.n_dot_v * parameters.tolerance;
  surface.per_inverse_depth = per_distance * surface.depth;
  surface.plane = vec3(surface.slope * parameters.tolerance,
                       kPerspective ? per_distance : per_distance * surface.inverse_depth);
}

// Returns the pixel's normal in the space of the normals, with any length except 0. If the texture
// has no valid normal, returns the direction to the eye instead. It is exact enough for the
// filter's weights. A NaN would stay in the history.
vec3 fetch_normal(ivec2 pixel) {
  if (kNormalEncoding == kNoNormals) return fetch_depth_normal(pixel);
  vec3 normal = fetch_given_normal(pixel);
  return has_direction(normal) ? normal : parameters.normal_from_view[2].xyz;
}

LobeSurface fetch_lobe_surface(ivec2 pixel, vec3 normal) {
#ifdef SPECULAR
  return LobeSurface(normalize(normal), fetch_roughness(in_inputs(pixel)));
#else
  return LobeSurface(normal, parameters.roughness);
#endif
}

#endif
