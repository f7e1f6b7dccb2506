#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Computes specular occlusion: the visible fraction of each pixel's GGX lobe, from its visibility
// and bent normal, by the paper's table ([Jimenez 2016], section 6).

#include "gtso_parameters.h"
#include "maths/gtso.h"
#include "maths/gtso_table.h"
#include "maths/slice.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool kRoughnessTexture = false;
layout(constant_id = 1) const int kRoughnessChannel = 0;
layout(constant_id = 2) const uint kNormalEncoding = 0;  // an AlcoveNormalEncoding
layout(constant_id = 3) const bool kAreas = false;  // images are read or written in part (areas.h)
layout(constant_id = 4) const bool kPerspective = true;
layout(constant_id = 5) const bool kReversed = false;  // raw depth is 1 at the near plane

layout(set = 0, binding = 0) uniform Parameters { GtsoParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D visibility_image;
layout(set = 0, binding = 2) uniform texture2D bent_normal_image;
layout(set = 0, binding = 3) uniform texture2D normal_image;
layout(set = 0, binding = 4) uniform texture2D depth_image;      // as the projection wrote it
layout(set = 0, binding = 5) uniform texture2D roughness_image;  // read with kRoughnessTexture
layout(set = 0, binding = 6) uniform writeonly image2D result_image;
layout(set = 0, binding = 7) readonly buffer Table { uint gtso_table[]; };

#define WRITES_OUTPUTS
#include "areas.h"
#include "fetch_roughness.h"
#include "traced_normal.h"

vec3 to_view_space(vec3 direction) { return mat3(parameters.view_from_normal) * direction; }

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

float occlusion_of(ivec2 pixel) {
  vec3 view = direction_to_eye(vec2(pixel) + 0.5);
  vec3 normal = traced_normal(pixel, to_view_space(fetch_given_normal(pixel)), view);
  vec3 given = texelFetch(bent_normal_image, in_outputs(pixel), 0).xyz;
  vec3 bent = has_direction(given) ? normalize(to_view_space(given)) : normal;
  float visibility = converged_visibility(texelFetch(visibility_image, in_outputs(pixel), 0).r);
  return occlusion_by_table(visibility, raised_bent_normal(bent, normal, visibility), normal,
                            mirror_direction(normal, view), fetch_roughness(in_inputs(pixel)));
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) + first_written();
  if (any(greaterThan(pixel, last_written()))) return;
  bool sky = is_sky_ndc(fetch_depth(pixel), kReversed);
  imageStore(result_image, in_outputs(pixel), vec4(sky ? 1.0 : occlusion_of(pixel)));
}
