// Part of gtao.comp: the surface that a traced pixel shows.
#ifndef ALCOVE_GTAO_SURFACE_H
#define ALCOVE_GTAO_SURFACE_H

#include "depth_normal.h"
#include "gtao_bindings.h"
#include "maths/normal_encoding.h"
#include "maths/raw_occlusion.h"
#include "maths/slice_line.h"

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

float fetch_roughness(ivec2 pixel) {
#ifdef SPECULAR
  if (kRoughnessTexture)
    return saturate(texelFetch(roughness_image, in_inputs(pixel), 0)[kRoughnessChannel]);
#endif
  return parameters.roughness;
}

float inverse_depth_of(float depth_ndc) {
  return inverse_depth_of_ndc(parameters.inverse_depth_from_ndc, depth_ndc, kPerspective,
                              kReversed);
}

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
  vec2 slope =
      parameters.slope.zw + (kPerspective ? centre_of(surface) * parameters.slope.xy : vec2(0.0));
  surface.view = normalize(vec3(-slope, 1.0));
  vec3 given = decode_normal(texelFetch(normal_image, in_inputs(pixel), 0).xyz, kNormalEncoding);
  vec3 given_vs = mat3(parameters.view_from_normal) * given;
  vec3 of_depth = vec3(0.0);
  if (needs_depth_normal(given_vs, surface.view)) {
    ivec2 origin = in_inputs(ivec2(0));
    DepthCross depths;
    if (kMask)
      depths = fetch_depth_cross(receiver_image, pixel, origin, size_px());
    else
      depths = fetch_depth_cross(depth_image, pixel, origin, size_px());
    of_depth = depth_buffer_normal(depths, pixel, size_px(), parameters.slope,
                                   parameters.inverse_depth_from_ndc, kPerspective, kReversed);
  }
  surface.normal = seen_normal(given_vs, surface.view, of_depth);
  vec3 own = has_direction(given) ? given : surface.normal * mat3(parameters.view_from_normal);
  surface.roughness = fetch_roughness(pixel);
  surface.lobe_surface =
      kLobe ? pack_lobe_surface(LobeSurface(normalize(own), surface.roughness)) : 0u;
  return surface;
}

#endif
