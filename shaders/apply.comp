#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Lights surfaces with a probe. Diffuse light comes from spherical harmonics along the bent normal.
// If compiled with SPECULAR, specular light comes from a prefiltered environment map with the
// split-sum approximation. Each is multiplied by its occlusion.

#include "apply_parameters.h"
#include "maths/gtso.h"
#include "maths/multi_bounce.h"
#include "maths/projection.h"
#include "maths/spherical_harmonics.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool kBentNormal = false;
layout(constant_id = 1) const bool kVisibility = false;
layout(constant_id = 2) const bool kMultiBounce = false;
layout(constant_id = 3) const bool kLight = false;
layout(constant_id = 4) const bool kParts = false;

layout(set = 0, binding = 0) uniform Parameters { ApplyParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D depth_image;  // linear
layout(set = 0, binding = 2) uniform texture2D normal_image;
layout(set = 0, binding = 3) uniform texture2D albedo_image;
// Images that the settings do not use are bound to another image and not read.
layout(set = 0, binding = 4) uniform texture2D bent_normal_image;
layout(set = 0, binding = 5) uniform texture2D visibility_image;
layout(set = 0, binding = 6) uniform texture2D light_image;
layout(set = 0, binding = 7) uniform texture2D harmonics_image;
layout(set = 0, binding = 8) uniform writeonly image2D lit_image;
layout(set = 0, binding = 9) uniform writeonly image2D diffuse_image;
#ifdef SPECULAR
#include "environment_fetch.h"
#include "maths/split_sum.h"

layout(constant_id = 5) const bool kRoughnessTexture = false;
layout(constant_id = 6) const int kRoughnessChannel = 0;
layout(constant_id = 7) const bool kMetallicTexture = false;
layout(constant_id = 8) const int kMetallicChannel = 0;
layout(constant_id = 9) const bool kSpecularOcclusion = false;

layout(set = 0, binding = 10) uniform writeonly image2D specular_image;
layout(set = 0, binding = 11) uniform texture2D roughness_image;
layout(set = 0, binding = 12) uniform texture2D metallic_image;
layout(set = 0, binding = 13) uniform texture2D specular_occlusion_image;
layout(set = 0, binding = 14) uniform texture2D map_image;
layout(set = 0, binding = 15) readonly buffer Table { uint reflectance_table[]; };
#endif

struct Light {
  vec3 diffuse;
  vec3 specular;
};

vec3 fetch_direction(texture2D image, ivec2 pixel, vec3 instead) {
  vec3 given = texelFetch(image, pixel, 0).xyz;
  return has_direction(given) ? normalize(mat3(parameters.world_from_normal) * given) : instead;
}

// Returns the bent normal. Its angle from the normal is limited to the largest angle that is
// possible at this visibility, so that noise of the bent normal is not visible on unoccluded
// surfaces.
vec3 fetch_bent_normal(ivec2 pixel, vec3 normal, float visibility) {
  vec3 bent = fetch_direction(bent_normal_image, pixel, normal);
  return kVisibility ? raised_bent_normal(bent, normal, converged_visibility(visibility)) : bent;
}

// Returns irradiance divided by pi. Spherical harmonics can give negative values next to bright
// light (ringing); these become 0.
vec3 irradiance(vec3 direction) {
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < kHarmonics; ++i) {
    sum += texelFetch(harmonics_image, ivec2(i, 0), 0).rgb *
           (harmonic(i, direction) * harmonic_irradiance(i));
  }
  return max(sum, vec3(0.0));
}

vec3 diffuse_light(ivec2 pixel, vec3 normal, vec3 albedo) {
  float visibility = kVisibility ? texelFetch(visibility_image, pixel, 0).r : 1.0;
  vec3 light = irradiance(kBentNormal ? fetch_bent_normal(pixel, normal, visibility) : normal);
  return light * (kMultiBounce ? multi_bounce(visibility, albedo) : vec3(visibility));
}

#ifdef SPECULAR
vec2 fetch_reflectance(float n_dot_v, float roughness) {
  vec2 at = reflectance_coordinates(n_dot_v, roughness);
  uvec2 low = min(uvec2(at), uvec2(kReflectanceTable - 2u));
  vec2 t = at - vec2(low);
  uint first = low.y * kReflectanceTable + low.x;
  vec2 near = mix(unpackUnorm2x16(reflectance_table[first]),
                  unpackUnorm2x16(reflectance_table[first + 1u]), t.x);
  first += kReflectanceTable;
  vec2 far = mix(unpackUnorm2x16(reflectance_table[first]),
                 unpackUnorm2x16(reflectance_table[first + 1u]), t.x);
  return mix(near, far, t.y);
}

vec3 environment_light(vec3 normal, vec3 view, float roughness) {
  float level = level_of_roughness(roughness, uint(parameters.map.y));
  vec3 direction = dominant_direction(normal, mirror_direction(normal, view), roughness);
  return fetch_map(map_image, parameters.map.x, level, direction);
}

// Returns the light from the directions of the specular lobe. The visible part of the lobe shows
// the environment. With multi-bounce, the occluded part shows occluders that are assumed to have
// the albedo and the lighting of the surface itself (`occluder`).
vec3 specular_light(ivec2 pixel, vec3 environment, vec3 occluder) {
  if (!kSpecularOcclusion) return environment;
  float visible = texelFetch(specular_occlusion_image, pixel, 0).r;
  return environment * visible + (kMultiBounce ? occluder * (1.0 - visible) : vec3(0.0));
}

Light light_of(ivec2 pixel, vec3 normal, vec3 view) {
  vec3 base = texelFetch(albedo_image, pixel, 0).rgb;
  float roughness = kRoughnessTexture
                        ? saturate(texelFetch(roughness_image, pixel, 0)[kRoughnessChannel])
                        : parameters.roughness;
  float metallic = kMetallicTexture ? texelFetch(metallic_image, pixel, 0)[kMetallicChannel]
                                    : parameters.metallic;
  vec2 table_value = fetch_reflectance(dot(normal, view), roughness);
  vec3 reflected = specular_reflectance(normal_reflectance(base, metallic), table_value);
  vec3 spread = diffuse_light(pixel, normal, base);
  Light light;
  light.diffuse = spread * diffuse_albedo(base, metallic) * (vec3(1.0) - reflected);
  light.specular =
      specular_light(pixel, environment_light(normal, view, roughness), spread * base) * reflected;
  return light;
}
#else
Light light_of(ivec2 pixel, vec3 normal, vec3 view) {
  vec3 albedo = texelFetch(albedo_image, pixel, 0).rgb;
  Light light;
  light.diffuse = diffuse_light(pixel, normal, albedo) * albedo;
  light.specular = vec3(0.0);
  return light;
}
#endif

// Returns the direction from the surface to the eye in world space.
vec3 view_of(ivec2 pixel, float depth) {
  vec2 uv = pixel_centre_uv(parameters.projection, uvec2(pixel));
  vec3 view = view_direction(parameters.projection, position_vs(parameters.projection, uv, depth));
  return mat3(parameters.world_from_view) * view;
}

void store(ivec2 pixel, Light light) {
  vec3 sum = light.diffuse + light.specular;
  if (kLight) sum += texelFetch(light_image, pixel, 0).rgb;
  imageStore(lit_image, pixel, vec4(sum, 1.0));
  if (kParts) {
    imageStore(diffuse_image, pixel, vec4(light.diffuse, 1.0));
#ifdef SPECULAR
    imageStore(specular_image, pixel, vec4(light.specular, 1.0));
#endif
  }
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(parameters.projection.size_px)))) return;
  float depth = texelFetch(depth_image, pixel, 0).r;
  Light light = Light(vec3(0.0), vec3(0.0));
  if (!is_sky_depth(depth)) {
    vec3 view = view_of(pixel, depth);
    light = light_of(pixel, fetch_direction(normal_image, pixel, view), view);
  }
  store(pixel, light);
}
