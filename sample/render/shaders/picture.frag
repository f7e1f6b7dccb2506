#version 460
#extension GL_GOOGLE_include_directive : require

#include "maths/constants.h"
#include "maths/environment_map.h"
#include "picture.h"

layout(set = 0, binding = 0) uniform sampler2D shown;
layout(set = 0, binding = 1) uniform sampler2D other;         // shown to the right of the split
layout(set = 0, binding = 2) uniform sampler2D linear_depth;  // for radiance
layout(set = 0, binding = 3) uniform sampler2D environment;   // for radiance: the map of the probe
layout(push_constant) uniform Push { PictureParameters parameters; };

layout(location = 0) out vec4 out_colour;

vec3 encode_srgb(vec3 linear) {
  vec3 x = clamp(linear, 0.0, 1.0);
  return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}

vec3 ray_direction(ivec2 pixel) {
  vec2 ndc = 2.0 * (vec2(pixel) + 0.5) / vec2(textureSize(shown, 0)) - 1.0;
  return normalize(mat3(parameters.world_from_shown) * vec3(ndc, 1.0));
}

vec3 display_colour(vec3 radiance, ivec2 pixel) {
  if (texelFetch(linear_depth, pixel, 0).r >= kSkyDepth)
    radiance = textureLod(environment, map_uv(ray_direction(pixel)), 0.0).rgb;
  return encode_srgb(1.0 - exp(-parameters.scale * radiance));
}

vec3 colour_of(vec4 texel, ivec2 pixel) {
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
      return display_colour(texel.rgb, pixel);
    default:
      return texel.rgb;
  }
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  bool beyond = gl_FragCoord.x >= parameters.split;
  vec4 texel = beyond ? texelFetch(other, pixel, 0) : texelFetch(shown, pixel, 0);
  bool seam = abs(gl_FragCoord.x - parameters.split) < 1.0;
  out_colour = vec4(seam ? vec3(1.0, 0.6, 0.1) : colour_of(texel, pixel), 1.0);
}
