#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Copies the depth of one pixel in 4x4 for the far samples of gtao.comp, whose loads then touch few
// cache lines. The pixel changes from frame to frame, so that a thin object is missed in some
// frames only. Texel (1,1) has the pixel at `offset`. The texels around the image, and those whose
// pixel lies outside of it, show the sky.

#include "gtao_parameters.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform Parameters { FarDepthParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D depth_image;
layout(set = 0, binding = 2) uniform writeonly image2D far_depth_image;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(far_depth_image)))) {
    return;
  }
  ivec2 pixel = 4 * (texel - 1) + ivec2(parameters.offset);
  bool inside = pixel == clamp(pixel, ivec2(0), textureSize(depth_image, 0) - 1);
  float depth_ndc = inside ? texelFetch(depth_image, pixel, 0).r : parameters.sky;
  imageStore(far_depth_image, texel, vec4(depth_ndc));
}
