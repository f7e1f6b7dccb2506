#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Copies depth. resolve_depth, with SAMPLES, copies sample 0 of a depth buffer with several samples
// per pixel: an average of the samples would lie on none of the surfaces. halve_depth copies every
// second pixel along x and y, for the search.

#include "depth_copy_parameters.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform Parameters { DepthCopyParameters parameters; };
#ifdef SAMPLES
layout(set = 0, binding = 1) uniform texture2DMS depth_image;
#else
layout(set = 0, binding = 1) uniform texture2D depth_image;
#endif
layout(set = 0, binding = 2) uniform writeonly image2D copy_image;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
#ifdef SAMPLES
  if (any(greaterThanEqual(texel, parameters.size))) return;
  texel += parameters.first;
  ivec2 pixel = texel;
#else
  if (any(greaterThanEqual(texel, imageSize(copy_image)))) return;
  ivec2 pixel = parameters.first + min(2 * texel, parameters.size - 1);
#endif
  imageStore(copy_image, texel, vec4(texelFetch(depth_image, pixel, 0).r));
}
