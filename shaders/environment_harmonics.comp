#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Computes the nine spherical-harmonics coefficients of an environment map as sums over the texels
// of one mip. Only one workgroup runs: each invocation sums a part of the texels, and then one
// invocation per coefficient adds up these partial sums.

#include "environment_parameters.h"
#include "maths/environment_map.h"
#include "maths/spherical_harmonics.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform Parameters { EnvironmentParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D source_image;  // size: parameters.size squared
layout(set = 0, binding = 2) uniform writeonly image2D target_image;

const uint kThreads = 64u;
shared vec3 shares[kHarmonics][kThreads];

void sum_texels(uint thread) {
  vec3 sums[kHarmonics];
  for (uint i = 0u; i < kHarmonics; ++i) sums[i] = vec3(0.0);
  uint size = uint(parameters.size);
  for (uint at = thread; at < size * size; at += kThreads) {
    uvec2 texel = uvec2(at % size, at / size);
    vec2 uv = (vec2(texel) + 0.5) / parameters.size;
    vec3 direction = map_direction(uv);
    vec3 light =
        texelFetch(source_image, ivec2(texel), 0).rgb * map_texel_angle(uv, parameters.size);
    for (uint i = 0u; i < kHarmonics; ++i) sums[i] += light * harmonic(i, direction);
  }
  for (uint i = 0u; i < kHarmonics; ++i) shares[i][thread] = sums[i];
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  sum_texels(thread);
  barrier();
  if (thread < kHarmonics) {
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < kThreads; ++i) sum += shares[thread][i];
    imageStore(target_image, ivec2(thread, 0), vec4(sum, 1.0));
  }
}
