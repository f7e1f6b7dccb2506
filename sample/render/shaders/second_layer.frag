#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Writes the depth of the second layer: the nearest front face behind the first layer at each
// pixel. Back faces are culled, so that the second layer is not the back of the first solid.

#include "cut_out.h"

layout(set = 0, binding = 0) uniform Parameters { GbufferParameters parameters; };
layout(set = 1, binding = 0) uniform texture2D first_depth;  // NDC depth, as gl_FragCoord.z

layout(location = 0) in vec2 base_colour_uv;
layout(location = 1) in float vertex_alpha;

float linear_depth(float depth_ndc) {
  vec4 p = parameters.depth_unproject;
  return (p.x * depth_ndc + p.y) / (p.z * depth_ndc + p.w);
}

void main() {
  float first = linear_depth(texelFetch(first_depth, ivec2(gl_FragCoord.xy), 0).r);
  // Discards the surface of the first layer, which is drawn again and is equal except for rounding.
  if (is_cut_out(base_colour_uv, vertex_alpha) || linear_depth(gl_FragCoord.z) <= first * 1.001)
    discard;
}
