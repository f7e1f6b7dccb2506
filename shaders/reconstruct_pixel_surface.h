// The surface of a pixel, the part of reconstruct.comp without HALF.
#ifndef ALCOVE_RECONSTRUCT_PIXEL_SURFACE_H
#define ALCOVE_RECONSTRUCT_PIXEL_SURFACE_H

#include "reconstruct_surface.h"

// Sets the tangent plane to that of a normal in the space of the normals.
void set_plane_of_normal(inout Surface surface, vec3 normal) {
  // `plane` is the normal of the tangent plane in the space of (x s, y s, depth): dot((x s, y s,
  // depth), plane) is constant on the plane. x and y are in pixels; s is the depth in perspective
  // and 1 otherwise.
  vec3 plane = normal * mat3(parameters.plane_from_normal);
  // How the distance from the plane grows with depth along the pixel's ray.
  float along = plane.z + (kPerspective ? dot(surface.place.centre, plane.xy) : 0.0);
  float per_length = inversesqrt(dot(normal, normal));
  surface.n_dot_v = max(abs(along) * per_length, kLeastNDotV);
  plane *= along < 0.0 ? per_length : -per_length;  // of the unit normal that faces the eye
  surface.slope = kPerspective ? -plane.xy : plane.xy;
  vec2 normal_xy = plane.xy * parameters.pixels_per_slope;
  surface.stereographic = vec3(normal_xy, 1.0 + dot(normal_xy, parameters.slope.zw) - plane.z);
  surface.lobe = fetch_lobe_surface(surface.pixel, normal);
}

// Returns Surface::stereographic for a HalfTexel::tilt.
vec3 stereographic_of_tilt(vec2 tilt, float n_dot_v) {
  vec2 xy = tilt * n_dot_v;
  return vec3(xy, 1.0 + sqrt(max(1.0 - dot(xy, xy), 0.0)));
}

Surface fetch_surface(Place place) {
  Surface surface;
  surface.place = place;
  surface.pixel = place.texel;
  // The pixel with its neighbours to the left and above, and with those to the right and below.
  vec4 before = gather_depth(place.texel, place.uv);
  vec4 after = gather_depth(place.texel + 1, place.uv + parameters.pixel_uv);
  float depth_ndc = after.w;
  surface.sky = is_sky_ndc(depth_ndc, kReversed);
  surface.inverse_depth = inverse_depth_of(depth_ndc);
  surface.depth = kPerspective ? 1.0 / surface.inverse_depth : 1.0;
  // The plane comes from the depths where they are linear, because a normal has more bytes.
  vec2 next = vec2(after.z, after.x);
  vec2 last = vec2(before.x, before.z);
  vec2 gradient = (next - last) * (parameters.half_inverse_depth_per_ndc * surface.depth);
  vec2 tilt = gradient * parameters.pixels_per_slope * mix(1.0, -1.0, kPerspective);
  // The pixel's ray matters to angles, but hardly to the scale of distances.
  float n_dot_v = kByNormal ? n_dot_v_of(tilt, place.centre) : inversesqrt(1.0 + dot(tilt, tilt));
  surface.n_dot_v = max(n_dot_v, kLeastNDotV);
  surface.slope = gradient * n_dot_v;
  surface.stereographic = stereographic_of_tilt(tilt, n_dot_v);
  vec2 bend = abs(next + last - 2.0 * depth_ndc);
  float off_plane = (max(bend.x, bend.y) + parameters.depth_step) * surface.depth * surface.n_dot_v;
  // The comparison is true for NaN.
  if (kFresh || kLobe || !(off_plane <= parameters.largest_bend))
    set_plane_of_normal(surface, fetch_normal(surface.pixel));
  return surface;
}

// Returns the unit normal in view space, as the search uses it.
vec3 traced_normal(Surface surface) {
  vec2 slope =
      parameters.slope.zw + (kPerspective ? surface.place.centre * parameters.slope.xy : vec2(0.0));
  vec3 given =
      decode_normal(texelFetch(normal_image, in_inputs(surface.pixel), 0).xyz, kNormalEncoding) *
      mat3(parameters.normal_from_view);
  vec3 view = normalize(vec3(-slope, 1.0));
  vec3 of_depth = vec3(0.0);
  if (needs_depth_normal(given, view)) {
    of_depth = depth_buffer_normal(
        fetch_depth_cross(depth_image, surface.pixel, in_inputs(ivec2(0)), size_px()),
        surface.pixel, size_px(), parameters.slope, parameters.inverse_depth_from_ndc, kPerspective,
        kReversed);
  }
  return seen_normal(given, view, of_depth);
}

#endif
