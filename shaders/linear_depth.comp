#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Converts a depth buffer to the distance along the view direction, in scene units.

#include "linear_depth_parameters.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform Parameters { LinearDepthParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D depth_ndc_image;
layout(set = 0, binding = 2) uniform writeonly image2D linear_depth_image;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(linear_depth_image)))) return;
  float depth_ndc = texelFetch(depth_ndc_image, pixel + parameters.origin, 0).r;
  imageStore(linear_depth_image, pixel, vec4(linear_depth(parameters.projection, depth_ndc)));
}
