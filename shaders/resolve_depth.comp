#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Copies sample 0 of a depth buffer with several samples per pixel. An average of the samples would
// lie on none of the surfaces. With HALF the depth buffer has one sample per pixel, and every
// second pixel along x and y is copied, for the search.

#include "depth_copy_parameters.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform Parameters { DepthCopyParameters parameters; };
#ifdef HALF
layout(set = 0, binding = 1) uniform texture2D depth_image;
#else
layout(set = 0, binding = 1) uniform texture2DMS depth_image;
#endif
layout(set = 0, binding = 2) uniform writeonly image2D resolved_image;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
#ifdef HALF
  if (any(greaterThanEqual(texel, imageSize(resolved_image)))) return;
  ivec2 pixel = parameters.first + min(2 * texel, parameters.size - 1);
#else
  if (any(greaterThanEqual(texel, parameters.size))) return;
  texel += parameters.first;
  ivec2 pixel = texel;
#endif
  imageStore(resolved_image, texel, vec4(texelFetch(depth_image, pixel, 0).r));
}
