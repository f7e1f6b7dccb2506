#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Copies sample 0 of a depth buffer with several samples per pixel. An average of the samples would
// lie on none of the surfaces.

#include "depth_copy_parameters.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform Parameters { DepthCopyParameters parameters; };
layout(set = 0, binding = 1) uniform texture2DMS depth_image;
layout(set = 0, binding = 2) uniform writeonly image2D resolved_image;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, parameters.size))) return;
  pixel += parameters.first;
  imageStore(resolved_image, pixel, vec4(texelFetch(depth_image, pixel, 0).r));
}
