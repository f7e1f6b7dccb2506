#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Halves the width and height of an environment map: each texel is the mean of four texels,
// weighted by the solid angles that they cover.

#include "environment_parameters.h"
#include "maths/environment_map.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform Parameters { EnvironmentParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D source_image;
layout(set = 0, binding = 2) uniform writeonly image2D target_image;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, ivec2(parameters.size)))) return;
  float source_size = parameters.source_px.x;
  vec4 sum = vec4(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 from = texel * 2 + ivec2(i & 1, i >> 1);
    float angle = map_texel_angle((vec2(from) + 0.5) / source_size, source_size);
    sum += vec4(texelFetch(source_image, from, 0).rgb, 1.0) * angle;
  }
  imageStore(target_image, texel, vec4(sum.rgb / sum.a, 1.0));
}
