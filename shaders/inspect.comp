#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Copies samples of a view's inputs, which the CPU then checks for mistakes (alcoveDiagnose).
//
// The samples are on a grid over the image. Each sample takes three texels side by side, with the
// members of PixelSample in diagnose/inspect.h. The last row begins with the sizes of the images of
// depth and normals.

#include "inspect_parameters.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform Parameters { InspectParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D depth_image;  // raw depth
layout(set = 0, binding = 2) uniform texture2D normal_image;
layout(set = 0, binding = 3) uniform texture2D motion_image;
layout(set = 0, binding = 4) uniform writeonly image2D sample_image;

// The part of an image from parameters.origin on. An image that is smaller than the view says is
// not read beyond its edge.
ivec2 rest_of(texture2D image) { return textureSize(image, 0) - ivec2(parameters.origin); }
ivec2 place_in(texture2D image, ivec2 pixel) {
  ivec2 last = min(ivec2(parameters.size_px), rest_of(image)) - 1;
  return clamp(pixel, ivec2(0), max(last, ivec2(0))) + ivec2(parameters.origin);
}

float fetch_depth(ivec2 pixel) {
  return texelFetch(depth_image, place_in(depth_image, pixel), 0).r;
}

void main() {
  ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (cell == ivec2(0, kInspectRows)) {
    imageStore(sample_image, cell, vec4(rest_of(depth_image), rest_of(normal_image)));
  }
  if (cell.x >= int(kInspectColumns) || cell.y >= int(kInspectRows)) return;
  vec2 position = (vec2(cell) + 0.5) / vec2(kInspectColumns, kInspectRows);
  ivec2 pixel = ivec2(position * vec2(parameters.size_px));
  vec3 normal = vec3(0.0);
  if (parameters.has_normals != 0u)
    normal = texelFetch(normal_image, place_in(normal_image, pixel), 0).xyz;
  vec2 motion = vec2(0.0);
  if (parameters.has_motion != 0u)
    motion = texelFetch(motion_image, place_in(motion_image, pixel), 0).xy;
  ivec2 texel = ivec2(3 * cell.x, cell.y);
  imageStore(sample_image, texel,
             vec4(fetch_depth(pixel), fetch_depth(pixel - ivec2(1, 0)),
                  fetch_depth(pixel + ivec2(1, 0)), fetch_depth(pixel - ivec2(0, 1))));
  imageStore(sample_image, texel + ivec2(1, 0), vec4(fetch_depth(pixel + ivec2(0, 1)), normal));
  imageStore(sample_image, texel + ivec2(2, 0), vec4(motion, pixel));
}
