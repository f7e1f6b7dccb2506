#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Raises the visibility of each pixel, separately for each colour channel, by the light that
// occluders reflect ([Jimenez 2016], section 5).

#include "maths/multi_bounce.h"
#include "multi_bounce_parameters.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool kAreas = false;  // images are read or written in part

layout(set = 0, binding = 0) uniform Parameters { MultiBounceParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D visibility_image;
layout(set = 0, binding = 2) uniform texture2D albedo_image;
layout(set = 0, binding = 3) uniform writeonly image2D result_image;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(parameters.size_px)))) return;
  ivec2 output_pixel = kAreas ? pixel + parameters.positions.zw : pixel;
  float visibility = texelFetch(visibility_image, output_pixel, 0).r;
  vec3 albedo = texelFetch(albedo_image, kAreas ? pixel + parameters.positions.xy : pixel, 0).rgb;
  imageStore(result_image, output_pixel, vec4(multi_bounce(visibility, albedo), 1.0));
}
