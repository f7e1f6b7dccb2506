#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Computes the distance along the view direction, in scene units, and normals from depth. The
// occlusion passes compute both where they need them; this pass serves other passes of an engine.

#include "depth_normal.h"
#include "surface_parameters.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool kPerspective = true;
layout(constant_id = 1) const bool kReversed = false;  // raw depth is 1 at the near plane

layout(set = 0, binding = 0) uniform Parameters { SurfaceParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D depth_image;  // as the projection wrote it
layout(set = 0, binding = 2) uniform writeonly image2D linear_depth_image;
layout(set = 0, binding = 3) uniform writeonly image2D normal_image;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = textureSize(depth_image, 0);
  if (any(greaterThanEqual(pixel, size))) return;
  DepthCross ndc = fetch_depth_cross(depth_image, pixel, ivec2(0), size);
  vec2 from_ndc = parameters.inverse_depth_from_ndc;
  float inverse_depth = inverse_depth_of_ndc(from_ndc, ndc.here, kPerspective, kReversed);
  float depth = kPerspective ? min(1.0 / inverse_depth, kSkyDepth) : inverse_depth;
  imageStore(linear_depth_image, pixel, vec4(depth));
  vec2 slope =
      parameters.slope.zw + (kPerspective ? (vec2(pixel) + 0.5) * parameters.slope.xy : vec2(0.0));
  vec3 normal = is_sky_ndc(ndc.here, kReversed)
                    ? normalize(vec3(-slope, 1.0))
                    : depth_buffer_normal(ndc, pixel, size, parameters.slope, from_ndc,
                                          kPerspective, kReversed);
  imageStore(normal_image, pixel, vec4(normal, 0.0));
}
