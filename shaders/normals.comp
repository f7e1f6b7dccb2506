#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Computes normals from depth for every pixel. The occlusion passes compute them where they need
// them; this pass serves other passes of an engine without normals.

#include "maths/slice.h"
#include "maths/slice_line.h"
#include "normals_parameters.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool kPerspective = true;

layout(set = 0, binding = 0) uniform Parameters { NormalsParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D depth_image;  // linear
layout(set = 0, binding = 2) uniform writeonly image2D normal_image;

ivec2 size_px() { return textureSize(depth_image, 0); }

float load_inverse_depth(ivec2 pixel) {
  float depth = texelFetch(depth_image, pixel, 0).r;
  return is_sky_depth(depth) ? sky_inverse_depth(kPerspective) : kPerspective ? 1.0 / depth : depth;
}

#include "depth_normal.h"

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, size_px()))) {
    return;
  }
  vec2 slope =
      kPerspective ? parameters.slope.zw + (vec2(pixel) + 0.5) * parameters.slope.xy : vec2(0.0);
  bool sky = load_inverse_depth(pixel) == sky_inverse_depth(kPerspective);
  vec3 normal = sky ? normalize(vec3(-slope, 1.0)) : depth_normal(pixel);
  imageStore(normal_image, pixel, vec4(normal, 0.0));
}
