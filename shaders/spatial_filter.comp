#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Averages the signal over a square of pixels whose borders count half: 5x5 of them hold each direction
// of the 4x4 pattern once, centred. A neighbour counts by its distance from the pixel's
// tangent plane, so a plane at any tilt is filtered whole and nothing leaks across an edge.

#include "maths/bent_normal.h"
#include "maths/gtao.h"
#include "maths/projection.h"
#include "maths/slice_line.h"
#include "spatial_filter_parameters.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const int kReach = 2;
layout(constant_id = 1) const bool kBentNormal = false;

layout(set = 0, binding = 0) uniform Parameters { SpatialFilterParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D signal_image;  // visible, open
layout(set = 0, binding = 2) uniform texture2D depth_image;   // linear
layout(set = 0, binding = 3) uniform texture2D normal_image;  // xyz, turned by view_from_normal
layout(set = 0, binding = 4) uniform texture2D bent_image;    // where there is none, the signal
layout(set = 0, binding = 5) uniform writeonly image2D visibility_image;
// In the space of the normals; bound to the visibility and never written where there is none.
layout(set = 0, binding = 6) uniform writeonly image2D bent_normal_image;

// Distance to the pixel's tangent plane as a linear form: a neighbour at offset (i, j) and depth z
// lies s * (i * per_px.x + j * per_px.y) + (z - depth) * per_depth from it, in tolerances: the size of
// a pixel at the centre's depth, times parameters.tolerance_px.
struct TangentPlane {
  vec2 per_px;
  float per_depth;
  float depth;
};

TangentPlane fetch_plane(ivec2 pixel, float depth) {
  Projection projection = parameters.projection;
  vec3 normal = mat3(parameters.view_from_normal) * texelFetch(normal_image, pixel, 0).xyz;
  vec2 per_px = ray_per_px(projection);
  float pixel_size = abs(per_px.y) * sample_scale(projection, depth);
  normal = normalize(normal) / (parameters.tolerance_px * pixel_size);
  vec2 uv = pixel_centre_uv(projection, uvec2(pixel));
  vec3 ray = position_vs(projection, uv, 1.0) - position_vs(projection, uv, 0.0);
  TangentPlane plane;
  plane.per_px = per_px * normal.xy;
  plane.per_depth = dot(normal, ray);
  plane.depth = depth;
  return plane;
}

float tangent_plane_weight(TangentPlane plane, vec2 offset, float depth) {
  float distance = sample_scale(parameters.projection, depth) * dot(offset, plane.per_px) +
                   (depth - plane.depth) * plane.per_depth;
  return max(1.0 - abs(distance), 0.0);
}

// The outermost neighbours on an axis lie half inside the window.
float window_weight(ivec2 offset) {
  return (abs(offset.x) == kReach ? 0.5 : 1.0) * (abs(offset.y) == kReach ? 0.5 : 1.0);
}

struct Sum {
  vec2 signal;
  vec3 bent;
};

Sum fetch_sum(ivec2 pixel, float weight) {
  Sum sum;
  sum.signal = weight * texelFetch(signal_image, pixel, 0).rg;
  sum.bent = kBentNormal ? weight * texelFetch(bent_image, pixel, 0).xyz : vec3(0.0);
  return sum;
}

Sum filter_signal(ivec2 pixel, ivec2 last, float depth) {
  TangentPlane plane = fetch_plane(pixel, depth);
  Sum sum = fetch_sum(pixel, 1.0);
  for (int y = -kReach; y <= kReach; ++y) {
    for (int x = -kReach; x <= kReach; ++x) {
      ivec2 offset = ivec2(x, y);
      ivec2 neighbour = pixel + offset;
      if (offset == ivec2(0) || any(lessThan(neighbour, ivec2(0))) ||
          any(greaterThan(neighbour, last))) {
        continue;
      }
      float neighbour_depth = texelFetch(depth_image, neighbour, 0).r;
      float weight =
          window_weight(offset) * tangent_plane_weight(plane, vec2(offset), neighbour_depth);
      Sum more = fetch_sum(neighbour, weight);
      sum.signal += more.signal;
      sum.bent += more.bent;
    }
  }
  return sum;
}

void store(ivec2 pixel, Sum sum) {
  float visibility = mean_visibility(sum.signal.x, sum.signal.y);
  imageStore(visibility_image, pixel, vec4(visibility));
  if (kBentNormal) {
    mat3 normal_from_view = transpose(mat3(parameters.view_from_normal));
    vec3 fallback = texelFetch(normal_image, pixel, 0).xyz;
    vec3 bent = finish_bent_normal(normal_from_view * sum.bent, fallback);
    imageStore(bent_normal_image, pixel, vec4(bent, 0.0));
  }
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 last = ivec2(parameters.projection.size_px) - 1;
  if (any(greaterThan(pixel, last))) {
    return;
  }
  float depth = texelFetch(depth_image, pixel, 0).r;
  bool filtered = kReach > 0 && !is_sky_depth(depth);
  store(pixel, filtered ? filter_signal(pixel, last, depth) : fetch_sum(pixel, 1.0));
}
