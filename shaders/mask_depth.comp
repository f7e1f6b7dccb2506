#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Copies a depth buffer without the surfaces that a mask excludes. In one copy, surfaces that do
// not receive occlusion are sky. In the other, surfaces that do not occlude are kNoOccluder. With
// INTEGER the mask is an image of integers, else of normalised values.

#include "depth_copy_parameters.h"
#include "maths/no_occluder.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform Parameters { DepthCopyParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D depth_image;
#ifdef INTEGER
layout(set = 0, binding = 2) uniform utexture2D mask_image;
#else
layout(set = 0, binding = 2) uniform texture2D mask_image;
#endif
layout(set = 0, binding = 3) uniform writeonly image2D receiver_image;
layout(set = 0, binding = 4) uniform writeonly image2D occluder_image;

uint fetch_mask(ivec2 pixel) {
#ifdef INTEGER
  return texelFetch(mask_image, pixel, 0).r;
#else
  return uint(texelFetch(mask_image, pixel, 0).r * 255.0 + 0.5);
#endif
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, parameters.size))) return;
  pixel += parameters.first;
  float depth = texelFetch(depth_image, pixel, 0).r;
  uint mask = fetch_mask(pixel);
  bool receives = (mask & parameters.not_receiving) == 0u;
  bool occludes = (mask & parameters.not_occluding) == 0u;
  imageStore(receiver_image, pixel, vec4(receives ? depth : parameters.sky));
  imageStore(occluder_image, pixel, vec4(occludes ? depth : kNoOccluder));
}
