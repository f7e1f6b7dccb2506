#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Computes specular occlusion: the visible fraction of each pixel's GGX lobe, from its visibility
// and bent normal, by the paper's table ([Jimenez 2016], section 6).

#include "gtso_parameters.h"
#include "maths/gtso.h"
#include "maths/gtso_table.h"
#include "maths/normal_encoding.h"
#include "maths/projection.h"
#include "maths/slice.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool kRoughnessTexture = false;
layout(constant_id = 1) const int kRoughnessChannel = 0;
layout(constant_id = 2) const uint kNormalEncoding = 0;  // AlcoveNormalEncoding of normal_image
layout(constant_id = 3) const bool kAreas = false;       // images are read or written in part

layout(set = 0, binding = 0) uniform Parameters { GtsoParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D visibility_image;
layout(set = 0, binding = 2) uniform texture2D bent_normal_image;
layout(set = 0, binding = 3) uniform texture2D normal_image;
layout(set = 0, binding = 4) uniform texture2D depth_image;      // linear
layout(set = 0, binding = 5) uniform texture2D roughness_image;  // read with kRoughnessTexture
layout(set = 0, binding = 6) uniform writeonly image2D result_image;
layout(set = 0, binding = 7) readonly buffer Table { uint gtso_table[]; };

#include "fetch_roughness.h"

// A pixel's position in the images of visibility, bent normals and the result. Pixels count from
// the corner of the area that is read.
ivec2 in_outputs(ivec2 pixel) { return kAreas ? pixel + parameters.written.zw : pixel; }

vec3 fetch_direction(texture2D image, ivec2 pixel, uint encoding, vec3 instead) {
  vec3 given = decode_normal(texelFetch(image, pixel, 0).xyz, encoding);
  return has_direction(given) ? normalize(mat3(parameters.view_from_normal) * given) : instead;
}

float fetch_entry(uvec4 entry) {
  uint index = gtso_index(entry);
  return float((gtso_table[index / 4u] >> (index % 4u * 8u)) & 255u) / 255.0;
}

float occlusion_by_table(float visibility, vec3 bent, vec3 normal, vec3 reflection,
                         float roughness) {
  float cone = visibility_cone(visibility);
  float bent_from_mirror = angle_between(bent, reflection);
  float exact = gtso_exact(visibility, cone, bent_from_mirror, roughness);
  if (exact >= 0.0) return exact;
  vec4 at = gtso_coordinates(cone, bent_from_mirror, angle_between(normal, reflection), roughness);
  uvec4 entry = gtso_entry(at);
  float sum = 0.0;
  for (uint corner = 0u; corner < 16u; ++corner)
    sum += gtso_corner_weight(at - vec4(entry), corner) * fetch_entry(gtso_corner(entry, corner));
  return sum;
}

float occlusion_of(ivec2 pixel, vec3 normal, vec3 view) {
  float visibility = converged_visibility(texelFetch(visibility_image, in_outputs(pixel), 0).r);
  float roughness = fetch_roughness(kAreas ? pixel + parameters.origins.zw : pixel);
  vec3 bent = raised_bent_normal(fetch_direction(bent_normal_image, in_outputs(pixel), 0u, normal),
                                 normal, visibility);
  return occlusion_by_table(visibility, bent, normal, mirror_direction(normal, view), roughness);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, parameters.size_px))) return;
  pixel = kAreas ? pixel + parameters.written.xy : pixel;
  float depth = texelFetch(depth_image, pixel, 0).r;
  float result = 1.0;
  if (!is_sky_depth(depth)) {
    vec2 uv = pixel_centre_uv(parameters.projection, uvec2(pixel));
    vec3 view =
        view_direction(parameters.projection, position_vs(parameters.projection, uv, depth));
    vec3 normal =
        facing_normal(fetch_direction(normal_image, kAreas ? pixel + parameters.origins.xy : pixel,
                                      kNormalEncoding, view),
                      view);
    result = occlusion_of(pixel, normal, view);
  }
  imageStore(result_image, in_outputs(pixel), vec4(result));
}
