#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Computes one mip of a prefiltered map: the environment's light through a GGX lobe whose view
// direction is its normal (Karis 2013). Each sample of the lobe reads the mip of the source whose
// texels cover about the solid angle of the sample (Colbert and Krivanek 2007).

#include "environment_fetch.h"
#include "environment_parameters.h"
#include "maths/ggx.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform Parameters { EnvironmentParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D source_image;
layout(set = 0, binding = 2) uniform writeonly image2D target_image;

mat3 frame_of(vec3 normal) {
  vec3 helper = abs(normal.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
  vec3 x = normalize(cross(helper, normal));
  return mat3(x, cross(normal, x), normal);
}

// Returns the source mip whose texels cover about twice the solid angle of one sample. `density` is
// the probability density of the sample per steradian.
float source_level(float density) {
  float sample_angle = 1.0 / (parameters.samples * density);
  float texel_angle = 4.0 * kPi / (parameters.source_px.x * parameters.source_px.x);
  return clamp(0.5 * log2(sample_angle / texel_angle) + 0.5, 0.0, parameters.levels - 1.0);
}

vec3 prefilter(vec3 normal, float alpha) {
  const vec3 up = vec3(0.0, 0.0, 1.0);
  mat3 world_from_lobe = frame_of(normal);
  vec4 sum = vec4(0.0);
  for (float i = 0.0; i < parameters.samples; i += 1.0) {
    vec3 half_vector =
        sample_ggx_normal(up, alpha, fract(0.5 + i * 0.6180339887), (i + 0.5) / parameters.samples);
    vec3 light = reflect(-up, half_vector);
    if (light.z > 0.0) {
      float level = source_level(ggx_reflection_density(up, up, light, alpha));
      vec3 direction = normalize(world_from_lobe * light);
      sum += vec4(fetch_map(source_image, parameters.source_px.x, level, direction), 1.0) * light.z;
    }
  }
  return sum.rgb / max(sum.a, 1e-6);
}

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, ivec2(parameters.size)))) return;
  vec3 normal = map_direction((vec2(texel) + 0.5) / parameters.size);
  float alpha = parameters.roughness * parameters.roughness;
  vec3 light = parameters.roughness > 0.0
                   ? prefilter(normal, alpha)
                   : fetch_map_level(source_image, parameters.source_px.x, 0, normal);
  imageStore(target_image, texel, vec4(light, 1.0));
}
