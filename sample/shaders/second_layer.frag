#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// The depth of what lies behind the first surface of each pixel: drawn with back faces culled, so
// that a solid's own back is not what is found, and with what the first layer shows left out.

#include "gbuffer.h"

layout(constant_id = 0) const uint kTextureCount = 1;

layout(set = 0, binding = 0) uniform Parameters { GbufferParameters parameters; };
layout(set = 0, binding = 1) uniform sampler2D textures[kTextureCount];
layout(set = 1, binding = 0) uniform texture2D first_depth;  // as gl_FragCoord.z has it
layout(push_constant) uniform Draw { GbufferDraw draw; };

layout(location = 0) in vec2 base_colour_uv;

float linear_depth(float depth_ndc) {
  vec4 p = parameters.depth_unproject;
  return (p.x * depth_ndc + p.y) / (p.z * depth_ndc + p.w);
}

void main() {
  vec4 base = draw.base_colour * texture(textures[draw.base_colour_texture], base_colour_uv);
  float first = linear_depth(texelFetch(first_depth, ivec2(gl_FragCoord.xy), 0).r);
  // The same surface, drawn again, rounds to within this.
  if (base.a < draw.alpha_cutoff || linear_depth(gl_FragCoord.z) <= first * 1.001) {
    discard;
  }
}
