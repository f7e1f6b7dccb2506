// Part of gtao.comp: the surface that a traced pixel shows.
#ifndef ALCOVE_GTAO_SURFACE_H
#define ALCOVE_GTAO_SURFACE_H

#include "gtao_bindings.h"
#include "maths/raw_occlusion.h"
#define RECEIVERS
#include "traced_normal.h"
#ifdef SPECULAR
#include "fetch_roughness.h"
#endif

// The surface that a traced pixel shows.
struct Surface {
  ivec2 pixel;
  float depth;  // linear, scene units
  float inverse_depth;
  vec3 normal;        // unit, view space
  vec3 view;          // unit, view space, towards the eye
  uint lobe_surface;  // packed LobeSurface, with the normal as the texture has it
  float roughness;    // perceptual, [0,1]
};

float load_inverse_depth(ivec2 pixel) {
  return inverse_depth_of(kMask ? texelFetch(receiver_image, in_inputs(pixel), 0).r
                                : fetch_depth(pixel));
}

// The centre of the surface's pixel, in pixels from the image's corner.
vec2 centre_of(Surface surface) { return vec2(surface.pixel) + 0.5; }

// The surface at a pixel that is not the sky, whose inverse depth is already loaded.
Surface fetch_surface(ivec2 pixel, float inverse_depth) {
  Surface surface;
  surface.pixel = pixel;
  surface.depth = kPerspective ? 1.0 / inverse_depth : inverse_depth;
  surface.inverse_depth = inverse_depth;
  surface.view = direction_to_eye(centre_of(surface));
  vec3 given = fetch_given_normal(pixel);
  surface.normal = traced_normal(pixel, mat3(parameters.view_from_normal) * given, surface.view);
  vec3 own = has_direction(given) ? given : surface.normal * mat3(parameters.view_from_normal);
#ifdef SPECULAR
  surface.roughness = fetch_roughness(in_inputs(pixel));
#else
  surface.roughness = parameters.roughness;
#endif
  surface.lobe_surface =
      kLobe ? pack_lobe_surface(LobeSurface(normalize(own), surface.roughness)) : 0u;
  return surface;
}

#endif
