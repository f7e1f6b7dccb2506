// Computes normals from depth, for pixels without a valid given normal.
#ifndef ALCOVE_DEPTH_NORMAL_H
#define ALCOVE_DEPTH_NORMAL_H

#include "maths/slice.h"
#include "maths/slice_line.h"

// The depth of a pixel and of its neighbours at -2, -1, 1 and 2 pixels along both axes. Beyond the
// border of the image they repeat the last pixel.
struct DepthCross {
  float here;
  vec4 row;
  vec4 column;
};

// Returns the position of the neighbour `i` of DepthCross along an axis.
int neighbour_place(int place, int i, int size) {
  return i < 2 ? max(place + i - 2, 0) : min(place + i - 1, size - 1);
}

// Fetches the depths around a pixel of the area of `size` pixels that begins at `origin`.
DepthCross fetch_depth_cross(texture2D image, ivec2 pixel, ivec2 origin, ivec2 size) {
  DepthCross found;
  found.here = texelFetch(image, origin + pixel, 0).r;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    ivec2 in_row = ivec2(neighbour_place(pixel.x, i, size.x), pixel.y);
    ivec2 in_column = ivec2(pixel.x, neighbour_place(pixel.y, i, size.y));
    found.row[i] = texelFetch(image, origin + in_row, 0).r;
    found.column[i] = texelFetch(image, origin + in_column, 0).r;
  }
  return found;
}

// Returns how badly the inverse depths of the first and second neighbour on one side continue that
// of the pixel: how far a line through them misses it. A quarter of the step to the first neighbour
// is added. It is needed on a strip that is two pixels wide: there, the lines on both sides miss,
// and the addition prefers the neighbour on the strip itself. At a crease between two planes the
// addition is too small to change the choice. The quarter is chosen.
float miss(float here, float first, float second) {
  return abs(2.0 * first - second - here) + 0.25 * abs(first - here);
}

// Returns the change of the inverse depth from one pixel to the next along an axis of the image. It
// uses the one of the two neighbours whose depth continues the pixel's surface better, because the
// other may belong to another surface. The result is 0 if both neighbours are sky. `line` holds the
// neighbours as DepthCross does, and `place` the position of the pixel on an image of `size`, both
// along the axis.
float inverse_depth_gradient(float here, vec4 line, int place, int size, bool perspective) {
  float before = line.y;
  float after = line.z;
  float miss_before = miss(here, before, line.x);
  float miss_after = miss(here, after, line.w);
  float sky = sky_inverse_depth(perspective);
  bool none_before = before == sky || place < 1;
  bool none_after = after == sky || place + 1 >= size;
  if (none_before || (!none_after && miss_after < miss_before))
    return none_after ? 0.0 : after - here;
  return here - before;
}

// Returns the unit normal, in view space and towards the eye, of a pixel with these inverse depths.
// `slope` is the slope of view rays: their change per pixel in xy, and that of the ray at the
// corner of the image in zw.
vec3 depth_normal(DepthCross depth, ivec2 pixel, ivec2 size, vec4 slope, bool perspective) {
  if (depth.here == sky_inverse_depth(perspective)) return vec3(0.0, 0.0, 1.0);
  vec2 gradient =
      vec2(inverse_depth_gradient(depth.here, depth.row, pixel.x, size.x, perspective),
           inverse_depth_gradient(depth.here, depth.column, pixel.y, size.y, perspective));
  return normal_of_gradient(slope.xy, slope.zw + (vec2(pixel) + 0.5) * slope.xy, depth.here,
                            gradient, perspective);
}

// Returns depth_normal() for values of a depth buffer. `from_ndc` is that of
// inverse_depth_of_ndc().
vec3 depth_buffer_normal(DepthCross ndc, ivec2 pixel, ivec2 size, vec4 slope, vec2 from_ndc,
                         bool perspective, bool reversed) {
  DepthCross depth;
  depth.here = inverse_depth_of_ndc(from_ndc, ndc.here, perspective, reversed);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    depth.row[i] = inverse_depth_of_ndc(from_ndc, ndc.row[i], perspective, reversed);
    depth.column[i] = inverse_depth_of_ndc(from_ndc, ndc.column[i], perspective, reversed);
  }
  return depth_normal(depth, pixel, size, slope, perspective);
}

// Whether seen_normal() needs the normal from depth.
bool needs_depth_normal(vec3 given, vec3 view) {
  float towards = dot(normalize(given), view);
  return !has_direction(given) || (towards < 0.0 && towards >= -kFlippedNormal);
}

// Returns the unit normal, in view space, of the side of the surface that the eye sees. `given` is
// the normal of the texture in view space, with any length, and `of_depth` the normal from depth,
// which is read only if needs_depth_normal(). If the given normal has no direction (zero, or not
// finite), the result is the normal from depth. If it faces away from the eye, but the cosine of
// its angle to the view direction is at least -kFlippedNormal, it may be the normal of the other
// side of the surface, or of a surface just beyond a silhouette. The normal from depth then decides
// whether it is flipped.
vec3 seen_normal(vec3 given, vec3 view, vec3 of_depth) {
  vec3 normal = normalize(given);
  if (needs_depth_normal(given, view))
    normal = !has_direction(given) ? of_depth : dot(normal, of_depth) < 0.0 ? -normal : normal;
  return facing_normal(normal, view);
}

#endif
