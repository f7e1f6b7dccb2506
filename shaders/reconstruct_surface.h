// The surface of a pixel, the part of reconstruct.comp without HALF.
#ifndef ALCOVE_RECONSTRUCT_SURFACE_H
#define ALCOVE_RECONSTRUCT_SURFACE_H

Surface fetch_surface(ivec2 pixel) {
  Surface surface;
  surface.texel = surface.pixel = pixel;
  surface.centre = vec2(pixel) + 0.5;
  float depth_ndc = texelFetch(depth_image, pixel, 0).r;
  surface.sky = is_sky(depth_ndc);
  surface.inverse_depth = inverse_depth_of(depth_ndc);
  surface.depth = kPerspective ? 1.0 / surface.inverse_depth : 1.0;
  surface.around = find_traced(pixel, 0.0);
  vec3 normal = fetch_normal(surface.pixel);
  // `plane` is the normal of the tangent plane in the space of (x s, y s, depth): dot((x s, y s,
  // depth), plane) is constant on the plane. x and y are in pixels; s is the depth in perspective
  // and 1 otherwise.
  vec3 plane = normal * mat3(parameters.plane_from_normal);
  // How the distance from the plane grows with depth along the pixel's ray.
  float along = plane.z + (kPerspective ? dot(surface.centre, plane.xy) : 0.0);
  float per_length = inversesqrt(dot(normal, normal));
  surface.n_dot_v = max(abs(along) * per_length, kLeastNDotV);
  plane *= along < 0.0 ? per_length : -per_length;  // of the unit normal that faces the eye
  surface.slope = kPerspective ? -plane.xy : plane.xy;
  vec2 normal_xy = plane.xy * parameters.pixels_per_slope;
  surface.stereographic = vec3(normal_xy, 1.0 + dot(normal_xy, parameters.slope.zw) - plane.z);
  surface.lobe = fetch_lobe_surface(surface.pixel, normal);
  return surface;
}

// Returns the unit normal in view space, as the search uses it.
vec3 traced_normal(Surface surface) {
  vec2 slope =
      parameters.slope.zw + (kPerspective ? surface.centre * parameters.slope.xy : vec2(0.0));
  vec3 given = decode_normal(texelFetch(normal_image, surface.pixel, 0).xyz, kNormalEncoding) *
               mat3(parameters.normal_from_view);
  return seen_normal(surface.pixel, given, normalize(vec3(-slope, 1.0)));
}

#endif
