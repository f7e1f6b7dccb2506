#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// The depth of what lies behind the first surface of each pixel: drawn with back faces culled, so
// that a solid's own back is not what is found, and with what the first layer shows left out.

#include "cut_out.h"

layout(set = 0, binding = 0) uniform Parameters { GbufferParameters parameters; };
layout(set = 1, binding = 0) uniform texture2D first_depth;  // as gl_FragCoord.z has it

layout(location = 0) in vec2 base_colour_uv;

float linear_depth(float depth_ndc) {
  vec4 p = parameters.depth_unproject;
  return (p.x * depth_ndc + p.y) / (p.z * depth_ndc + p.w);
}

void main() {
  float first = linear_depth(texelFetch(first_depth, ivec2(gl_FragCoord.xy), 0).r);
  // The same surface, drawn again, rounds to within this.
  if (is_cut_out(base_colour_uv) || linear_depth(gl_FragCoord.z) <= first * 1.001) {
    discard;
  }
}
