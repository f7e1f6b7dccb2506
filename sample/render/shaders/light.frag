#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Lights surfaces with an environment: diffuse light along the bent normal, and specular light of
// the GGX lobe, each times its occlusion. Both are integrated by samples that read the mip whose
// texels cover about half the sample's solid angle (Colbert and Krivanek 2007). Materials are those
// of glTF 2.0. Diffuse light gets the energy that is not reflected specularly.

#include "light.h"
#include "maths/ggx.h"
#include "maths/gtso.h"
#include "maths/multi_bounce.h"

layout(set = 0, binding = 0) uniform texture2D images[kLightImages];
layout(set = 0, binding = 1) uniform sampler linear;
layout(push_constant) uniform Push { LightParameters parameters; };

layout(location = 0) out vec4 out_lit;  // the sum of the next two; the environment in the sky
layout(location = 1) out vec4 out_diffuse;
layout(location = 2) out vec4 out_specular;

const int kSamples = 64;

bool uses(uint bit) { return (parameters.uses & bit) != 0u; }

// Returns the mean radiance of about `solid_angle` steradians around a unit direction.
vec3 environment(vec3 direction, float solid_angle) {
  vec2 size = vec2(textureSize(images[kLightEnvironment], 0));
  float sine = length(direction.xz);
  vec2 uv = vec2(atan(direction.x, -direction.z) / (2.0 * kPi), atan(sine, direction.y) / kPi);
  float texel_angle = 2.0 * kPi * kPi / (size.x * size.y) * max(sine, 1.0 / size.y);
  float mip = 0.5 * log2(max(0.5 * solid_angle / texel_angle, 1.0));
  return textureLod(sampler2D(images[kLightEnvironment], linear), uv, mip).rgb;
}

// Returns two numbers in [0,1) for a sample.
vec2 sample_point(int i) {
  return vec2(fract(0.5 + float(i) * 0.6180339887), (float(i) + 0.5) / float(kSamples));
}

mat3 frame_of(vec3 normal) {
  vec3 helper = abs(normal.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
  vec3 x = normalize(cross(helper, normal));
  return mat3(x, cross(normal, x), normal);
}

// Returns the irradiance divided by pi.
vec3 irradiance(vec3 normal) {
  mat3 frame = frame_of(normal);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < kSamples; ++i) {
    vec2 u = sample_point(i);
    float angle = 2.0 * kPi * u.x, cosine = sqrt(1.0 - u.y);
    vec3 direction = vec3(sqrt(u.y) * vec2(cos(angle), sin(angle)), cosine);
    sum += environment(frame * direction, kPi / (cosine * float(kSamples)));
  }
  return sum / float(kSamples);
}

// `reflectance` is the light in a white environment.
vec3 specular_light(vec3 normal, vec3 view_ws, vec3 f0, float alpha, out vec3 reflectance) {
  mat3 frame = frame_of(normal);
  vec3 view = view_ws * frame;
  view = normalize(vec3(view.xy, max(view.z, 1e-3)));
  vec3 sum = reflectance = vec3(0.0);
  for (int i = 0; i < kSamples; ++i) {
    vec2 u = sample_point(i);
    vec3 half_vector = sample_ggx_normal(view, alpha, u.x, u.y);
    vec3 light = reflect(-view, half_vector);
    if (light.z <= 0.0) continue;
    float schlick = pow(1.0 - saturate(dot(view, half_vector)), 5.0);
    vec3 share = mix(f0, vec3(1.0), schlick) * ggx_shadowing(view.z, light.z, alpha) /
                 (ggx_masking(view.z, alpha) * float(kSamples));
    float density = ggx_reflection_density(vec3(0.0, 0.0, 1.0), view, light, alpha);
    sum += share * environment(frame * light, 1.0 / (density * float(kSamples)));
    reflectance += share;
  }
  return sum;
}

vec3 fetch_direction(uint image, ivec2 pixel, vec3 fallback) {
  vec3 given = texelFetch(images[image], pixel, 0).xyz;
  return has_direction(given) ? normalize(mat3(parameters.world_from_normal) * given) : fallback;
}

// Returns the diffuse light on a surface. The angle of the bent normal from the normal is limited
// to the largest angle that is possible at this visibility.
vec3 diffuse_light(ivec2 pixel, vec3 normal, vec3 albedo) {
  float visibility = uses(kUsesVisibility) ? texelFetch(images[kLightVisibility], pixel, 0).r : 1.0;
  vec3 direction = normal;
  if (uses(kUsesBentNormal)) {
    direction = raised_bent_normal(fetch_direction(kLightBentNormal, pixel, normal), normal,
                                   converged_visibility(visibility));
  }
  return irradiance(direction) *
         (uses(kUsesMultiBounce) ? multi_bounce(visibility, albedo) : vec3(visibility));
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec2 ndc = 2.0 * gl_FragCoord.xy / vec2(textureSize(images[kLightDepth], 0)) - 1.0;
  vec3 view = -normalize(mat3(parameters.world_from_ndc) * vec3(ndc, 1.0));
  out_lit = vec4(environment(-view, 0.0), 1.0);
  out_diffuse = out_specular = vec4(0.0, 0.0, 0.0, 1.0);
  if (texelFetch(images[kLightDepth], pixel, 0).r == parameters.sky_depth) return;
  vec3 normal = fetch_direction(kLightNormal, pixel, view);
  vec4 base = texelFetch(images[kLightAlbedo], pixel, 0);
  float roughness = saturate(parameters.roughness < 0.0 ? base.a : parameters.roughness);
  float metallic = saturate(texelFetch(images[kLightEmissive], pixel, 0).a);
  vec3 reflectance, f0 = mix(vec3(0.04), base.rgb, metallic);
  vec3 specular = specular_light(normal, view, f0, roughness * roughness, reflectance);
  vec3 diffuse = diffuse_light(pixel, normal, base.rgb);
  if (uses(kUsesSpecular)) {
    // With multi-bounce, the occluded part of the lobe shows occluders that are assumed to have the
    // albedo and the lighting of the surface itself.
    vec3 occluder = uses(kUsesMultiBounce) ? diffuse * base.rgb : vec3(0.0);
    float visible = texelFetch(images[kLightSpecular], pixel, 0).r;
    specular = mix(occluder * reflectance, specular, visible);
  }
  out_diffuse.rgb = diffuse * base.rgb * (1.0 - metallic) * (1.0 - reflectance);
  out_specular.rgb = specular;
  out_lit.rgb = out_diffuse.rgb + out_specular.rgb;
}
