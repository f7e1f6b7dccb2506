// Computes normals from depth, for pixels whose given normal is missing. A shader that includes
// this file must define load_inverse_depth(), parameters.slope, kPerspective and size_px().
#ifndef ALCOVE_DEPTH_NORMAL_H
#define ALCOVE_DEPTH_NORMAL_H

// Marks the change of depth towards a pixel of the sky.
const float kNoSurface = 1e30;

float inverse_depth_rise(ivec2 pixel, float here) {
  float there = load_inverse_depth(pixel);
  return there == sky_inverse_depth(kPerspective) ? kNoSurface : there - here;
}

// Returns the change of the inverse depth from one pixel to the next along an axis of the image. It
// uses the one of the two neighbours whose depth is closer to that of the pixel, which is more
// likely to be on the same surface. The result is 0 if both neighbours are sky.
float inverse_depth_gradient(ivec2 pixel, ivec2 axis, float here) {
  ivec2 last = size_px() - 1;
  float before = -inverse_depth_rise(max(pixel - axis, ivec2(0)), here);
  float after = inverse_depth_rise(min(pixel + axis, last), here);
  bool first = any(lessThan(pixel - axis, ivec2(0)));
  bool final = any(greaterThan(pixel + axis, last));
  float nearer = first || (!final && abs(after) < abs(before)) ? after : before;
  return abs(nearer) < kNoSurface ? nearer : 0.0;
}

// Returns the unit normal from depth in view space. It points towards the eye.
vec3 depth_normal(ivec2 pixel) {
  float here = load_inverse_depth(pixel);
  if (here == sky_inverse_depth(kPerspective)) {
    return vec3(0.0, 0.0, 1.0);
  }
  vec2 gradient = vec2(inverse_depth_gradient(pixel, ivec2(1, 0), here),
                       inverse_depth_gradient(pixel, ivec2(0, 1), here));
  vec2 slope = parameters.slope.zw + (vec2(pixel) + 0.5) * parameters.slope.xy;
  return normal_of_gradient(parameters.slope.xy, slope, here, gradient, kPerspective);
}

// Returns the unit normal, in view space, of the side of the surface that the eye sees. `given` is
// the normal of the texture in view space, with any length. If it has no direction (zero, or not
// finite), the normal is computed from depth. If it faces away from the eye, but the cosine of its
// angle to the view direction is at least -kFlippedNormal, it may be the normal of the other side
// of the surface, or of a surface just beyond a silhouette. The normal from depth then decides
// whether it is flipped.
vec3 seen_normal(ivec2 pixel, vec3 given, vec3 view) {
  bool missing = !has_direction(given);
  vec3 normal = normalize(given);
  float towards = dot(normal, view);
  if (missing || (towards < 0.0 && towards >= -kFlippedNormal)) {
    vec3 of_depth = depth_normal(pixel);
    normal = missing ? of_depth : dot(normal, of_depth) < 0.0 ? -normal : normal;
  }
  return facing_normal(normal, view);
}

#endif
