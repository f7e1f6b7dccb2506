// Computes normals from depth, for pixels without a valid given normal. A shader that includes this
// file must define load_inverse_depth(), parameters.slope, kPerspective and size_px().
#ifndef ALCOVE_DEPTH_NORMAL_H
#define ALCOVE_DEPTH_NORMAL_H

// Returns how badly the inverse depths of the first and second neighbour on one side continue that
// of the pixel: how far a line through them misses it. A quarter of the step to the first neighbour
// is added. It is needed on a strip that is two pixels wide: there, the lines on both sides miss,
// and the addition prefers the neighbour on the strip itself. At a crease between two planes the
// addition is too small to change the choice.
float miss(float here, float first, float second) {
  return abs(2.0 * first - second - here) + 0.25 * abs(first - here);
}

// Returns the change of the inverse depth from one pixel to the next along an axis of the image. It
// uses the one of the two neighbours whose depth continues the pixel's surface better, because the
// other may belong to another surface. The result is 0 if both neighbours are sky.
float inverse_depth_gradient(ivec2 pixel, ivec2 axis, float here) {
  ivec2 last = size_px() - 1;
  float before = load_inverse_depth(max(pixel - axis, ivec2(0)));
  float after = load_inverse_depth(min(pixel + axis, last));
  float miss_before = miss(here, before, load_inverse_depth(max(pixel - 2 * axis, ivec2(0))));
  float miss_after = miss(here, after, load_inverse_depth(min(pixel + 2 * axis, last)));
  float sky = sky_inverse_depth(kPerspective);
  bool none_before = before == sky || any(lessThan(pixel, axis));
  bool none_after = after == sky || any(greaterThan(pixel + axis, last));
  if (none_before || (!none_after && miss_after < miss_before)) {
    return none_after ? 0.0 : after - here;
  }
  return here - before;
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
