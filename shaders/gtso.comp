#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// The visible share of each pixel's GGX lobe from its visibility and bent normal (Jimenez et al. 2016,
// section 6), by one of the models of maths/gtso.h.

#include "gtso_parameters.h"
#include "maths/gtso.h"
#include "maths/projection.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const int kModel = 0;  // SpecularModel
layout(constant_id = 1) const bool kRoughnessTexture = false;
layout(constant_id = 2) const int kRoughnessChannel = 0;

layout(set = 0, binding = 0) uniform Parameters { GtsoParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D visibility_image;
layout(set = 0, binding = 2) uniform texture2D bent_normal_image;  // unread by kLagarde
layout(set = 0, binding = 3) uniform texture2D normal_image;
layout(set = 0, binding = 4) uniform texture2D depth_image;        // linear
layout(set = 0, binding = 5) uniform texture2D roughness_image;    // unread where there is none
layout(set = 0, binding = 6) uniform writeonly image2D result_image;

const int kSmoothCone = 1;
const int kLagarde = 2;

vec3 fetch_direction(texture2D image, ivec2 pixel) {
  return normalize(mat3(parameters.view_from_normal) * texelFetch(image, pixel, 0).xyz);
}

float fetch_alpha(ivec2 pixel) {
  float roughness = kRoughnessTexture
                        ? clamp(texelFetch(roughness_image, pixel, 0)[kRoughnessChannel], 0.0, 1.0)
                        : parameters.roughness;
  return roughness * roughness;
}

float occlusion_of(ivec2 pixel, vec3 normal, vec3 view) {
  float visibility = settled_visibility(texelFetch(visibility_image, pixel, 0).r);
  float alpha = fetch_alpha(pixel);
  if (kModel == kLagarde) {
    return lagarde_specular_occlusion(dot(normal, view), visibility, alpha);
  }
  vec3 bent = raised_bent_normal(fetch_direction(bent_normal_image, pixel), normal, visibility);
  vec3 reflection = mirror_direction(normal, view);
  return kModel == kSmoothCone
             ? smooth_specular_occlusion(visibility, bent, normal, reflection, alpha)
             : specular_occlusion(visibility, bent, normal, reflection, alpha);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(parameters.projection.size_px)))) {
    return;
  }
  float depth = texelFetch(depth_image, pixel, 0).r;
  float result = 1.0;
  if (!is_sky_depth(depth)) {
    vec2 uv = pixel_centre_uv(parameters.projection, uvec2(pixel));
    vec3 view = view_vector(parameters.projection, position_vs(parameters.projection, uv, depth));
    result = occlusion_of(pixel, fetch_direction(normal_image, pixel), view);
  }
  imageStore(result_image, pixel, vec4(result));
}
