#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#include "picture.h"

layout(set = 0, binding = 0) uniform texture2D shown[2];  // the second right of the split
layout(push_constant) uniform Push { PictureParameters parameters; };

layout(location = 0) out vec4 out_colour;

vec3 encode_srgb(vec3 linear) {
  vec3 x = clamp(linear, 0.0, 1.0);
  return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}

vec3 colour_of(vec4 texel) {
  switch (parameters.show) {
    case kShowGrey:
      return texel.rrr;
    case kShowDirection:
      return 0.5 * (mat3(parameters.world_from_shown) * texel.xyz) + 0.5;
    case kShowDepth:
      return vec3(texel.r / (texel.r + parameters.scale));
    case kShowMotion:
      return vec3(0.5 + 0.5 * parameters.scale * texel.rg, 0.5);
    case kShowRadiance:
      return encode_srgb(1.0 - exp(-parameters.scale * texel.rgb));
    default:
      return texel.rgb;
  }
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy + parameters.band);
  bool beyond = gl_FragCoord.x >= parameters.split;
  vec4 texel = beyond ? texelFetch(shown[1], pixel, 0) : texelFetch(shown[0], pixel, 0);
  bool seam = abs(gl_FragCoord.x - parameters.split) < 1.0;
  out_colour = vec4(seam ? vec3(1.0, 0.6, 0.1) : colour_of(texel), 1.0);
}
