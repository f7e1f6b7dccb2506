#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Resamples an equirectangular image to an octahedral map. Each texel is the mean of several
// bilinear reads. NaN and negative values count as black, and values above 65504 (the largest half
// float) as 65504.

#include "environment_parameters.h"
#include "maths/environment_map.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform Parameters { EnvironmentParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D source_image;
layout(set = 0, binding = 2) uniform writeonly image2D target_image;

const float kLargestHalf = 65504.0;

// Reads a texel of the source. Columns wrap around, rows are clamped at the poles.
vec3 fetch(ivec2 texel) {
  ivec2 size = ivec2(parameters.source_px);
  ivec2 at = ivec2((texel.x + size.x) % size.x, clamp(texel.y, 0, size.y - 1));
  vec3 light = texelFetch(source_image, at, 0).rgb;
  bvec3 good = greaterThan(light, vec3(0.0));
  return mix(vec3(0.0), min(light, vec3(kLargestHalf)), good);
}

vec3 fetch_bilinear(vec3 direction) {
  vec2 texel = equirectangular_uv(direction) * parameters.source_px - 0.5;
  ivec2 low = ivec2(floor(texel));
  vec2 t = texel - vec2(low);
  return mix(mix(fetch(low), fetch(low + ivec2(1, 0)), t.x),
             mix(fetch(low + ivec2(0, 1)), fetch(low + ivec2(1, 1)), t.x), t.y);
}

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, ivec2(parameters.size)))) return;
  int samples = int(parameters.samples);
  vec3 sum = vec3(0.0);
  for (int y = 0; y < samples; ++y) {
    for (int x = 0; x < samples; ++x) {
      vec2 within = (vec2(x, y) + 0.5) / parameters.samples;
      sum += fetch_bilinear(map_direction((vec2(texel) + within) / parameters.size));
    }
  }
  imageStore(target_image, texel, vec4(sum / float(samples * samples), 1.0));
}
