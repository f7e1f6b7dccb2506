#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Computes normals from depth for every pixel. The occlusion passes compute them where they need
// them; this pass serves other passes of an engine without normals.

#include "depth_normal.h"
#include "maths/slice_line.h"
#include "normals_parameters.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool kPerspective = true;

layout(set = 0, binding = 0) uniform Parameters { NormalsParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D depth_image;  // linear
layout(set = 0, binding = 2) uniform writeonly image2D normal_image;

float inverse_depth(float depth) {
  return is_sky_depth(depth) ? sky_inverse_depth(kPerspective) : kPerspective ? 1.0 / depth : depth;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = textureSize(depth_image, 0);
  if (any(greaterThanEqual(pixel, size))) return;
  DepthCross depth = fetch_depth_cross(depth_image, pixel, ivec2(0), textureSize(depth_image, 0));
  depth.here = inverse_depth(depth.here);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    depth.row[i] = inverse_depth(depth.row[i]);
    depth.column[i] = inverse_depth(depth.column[i]);
  }
  vec2 slope =
      kPerspective ? parameters.slope.zw + (vec2(pixel) + 0.5) * parameters.slope.xy : vec2(0.0);
  bool sky = depth.here == sky_inverse_depth(kPerspective);
  vec3 normal = sky ? normalize(vec3(-slope, 1.0))
                    : depth_normal(depth, pixel, size, parameters.slope, kPerspective);
  imageStore(normal_image, pixel, vec4(normal, 0.0));
}
