#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Computes normals from depth. On each image axis, it uses the one of the two neighbours whose
// depth continues the pixel's surface more smoothly, because the other may belong to another
// surface.

#include "maths/projection.h"
#include "maths/slice.h"
#include "normals_parameters.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform Parameters { NormalsParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D depth_image;  // linear
layout(set = 0, binding = 2) uniform writeonly image2D normal_image;

float fetch_depth(ivec2 pixel) {
  ivec2 last = ivec2(parameters.projection.size_px) - 1;
  return texelFetch(depth_image, clamp(pixel, ivec2(0), last), 0).r;
}

vec3 fetch_position(ivec2 pixel, float depth) {
  return position_vs(parameters.projection, pixel_centre_uv(parameters.projection, uvec2(pixel)),
                     depth);
}

// Returns how badly the depths one and two pixels away continue the pixel's surface: the distance
// by which a line through them misses the pixel's depth. In perspective, inverse depths are
// compared, because they are linear on the image of a plane. A quarter of the difference from the
// adjacent depth is added. It is needed on a strip that is two pixels wide: there, the lines on
// both sides miss, and the addition prefers the neighbour on the strip itself. At a crease between
// two planes the addition is too small to change the choice.
float miss(float depth, float one, float two) {
  vec3 inverse_depth = vec3(depth, one, two);
  if (parameters.projection.eye.w > 0.0) {
    inverse_depth = 1.0 / inverse_depth;
  }
  return abs(2.0 * inverse_depth.y - inverse_depth.z - inverse_depth.x) +
         0.25 * abs(inverse_depth.y - inverse_depth.x);
}

// Returns the vector between the positions of the pixel and of one of its two neighbours along an
// image axis: the neighbour whose depth continues the pixel's surface better. The vector points in
// the positive direction of the axis.
vec3 tangent(ivec2 pixel, ivec2 axis, float depth) {
  ivec2 last = ivec2(parameters.projection.size_px) - 1;
  float before = fetch_depth(pixel - axis);
  float after = fetch_depth(pixel + axis);
  float miss_before = miss(depth, before, fetch_depth(pixel - 2 * axis));
  float miss_after = miss(depth, after, fetch_depth(pixel + 2 * axis));
  bool first = any(lessThan(pixel - axis, ivec2(0)));
  bool final = any(greaterThan(pixel + axis, last));
  bool none_before = first || is_sky_depth(before);
  bool none_after = final || is_sky_depth(after);
  bool take_after = none_before || (!none_after && miss_after < miss_before);
  // If both neighbours are sky, the surface is assumed to face the eye along this axis: the
  // neighbours are given the depth of the pixel.
  before = none_before ? depth : before;
  after = none_after ? depth : after;
  vec3 here = fetch_position(pixel, depth);
  vec3 there = take_after ? fetch_position(pixel + axis, after) - here
                          : here - fetch_position(pixel - axis, before);
  return normalize(there);  // so that the cross product of distant points does not overflow
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(parameters.projection.size_px)))) {
    return;
  }
  float depth = fetch_depth(pixel);
  vec3 view = view_direction(parameters.projection, fetch_position(pixel, min(depth, 1e6)));
  if (is_sky_depth(depth)) {
    imageStore(normal_image, pixel, vec4(view, 0.0));
    return;
  }
  // y points down on the image. If the projection is flipped in y, the cross product has the wrong
  // sign, and the test below turns the normal towards the eye.
  vec3 normal = cross(tangent(pixel, ivec2(0, 1), depth), tangent(pixel, ivec2(1, 0), depth));
  float squared = dot(normal, normal);
  normal = squared > 0.0 ? normal * inversesqrt(squared) : view;
  normal = dot(normal, view) < 0.0 ? -normal : normal;
  imageStore(normal_image, pixel, vec4(normal, 0.0));
}
