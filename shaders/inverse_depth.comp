#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Raw depth as the searches want it: linear along the image of any plane (maths/slice_line.h), sky
// and what is not a number told apart, in an image that is read without a sampler's arithmetic.

#include "inverse_depth_parameters.h"
#include "maths/slice_line.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool kPerspective = true;
layout(constant_id = 1) const bool kReversed = false;

layout(set = 0, binding = 0) uniform Parameters { InverseDepthParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D depth_image;  // as the projection wrote it
layout(set = 0, binding = 2, r32f) uniform writeonly image2D inverse_depth_image;

// The test of is_sky_ndc() for a depth buffer of known direction.
bool is_sky(float ndc) { return kReversed ? !(ndc > 0.0) : !(ndc < 1.0); }

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(inverse_depth_image)))) {
    return;
  }
  float ndc = texelFetch(depth_image, pixel, 0).r;
  float inverse_depth = inverse_depth_of_ndc(parameters.inverse_depth_from_ndc, ndc, kPerspective);
  imageStore(inverse_depth_image, pixel,
             vec4(is_sky(ndc) ? sky_inverse_depth(kPerspective) : inverse_depth));
}
