#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Linear depth and up to four smaller mips of it, in one dispatch: a group of 8x8 threads owns
// 16x16 pixels, and each mip is reduced from the one above in shared memory. The pyramid covers the
// image rounded down, as Vulkan's mips do: the last odd row and column are in mip 0 only.

#include "linear_depth_parameters.h"
#include "maths/pyramid.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint kMipCount = 1;

layout(set = 0, binding = 0) uniform Parameters { LinearDepthParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D depth_ndc_image;
// With fewer mips the rest is bound to the last and never written.
layout(set = 0, binding = 2) uniform writeonly image2D mip_0;
layout(set = 0, binding = 3) uniform writeonly image2D mip_1;
layout(set = 0, binding = 4) uniform writeonly image2D mip_2;
layout(set = 0, binding = 5) uniform writeonly image2D mip_3;
layout(set = 0, binding = 6) uniform writeonly image2D mip_4;

shared float shared_depth[8][8];

float fetch_linear(ivec2 pixel) {
  ivec2 last = ivec2(parameters.projection.size_px) - 1;
  float ndc = texelFetch(depth_ndc_image, min(pixel, last), 0).r;
  float depth = linear_depth(parameters.projection, ndc);
  if (all(lessThanEqual(pixel, last))) {
    imageStore(mip_0, pixel, vec4(depth));
  }
  return depth;
}

float reduce_mip_0(ivec2 texel) {
  ivec2 pixel = texel * 2;
  vec4 depths = vec4(fetch_linear(pixel), fetch_linear(pixel + ivec2(1, 0)),
                     fetch_linear(pixel + ivec2(0, 1)), fetch_linear(pixel + ivec2(1, 1)));
  return kMipCount > 1 ? average_depth(depths, parameters.reach) : 0.0;
}

// Reduces the shared square of 2 * `side` texels to one of `side`; true for the threads that did.
bool reduce_shared(uvec2 local, uint side, float reach, out float depth) {
  barrier();
  bool reduces = local.x < side && local.y < side;
  depth = 0.0;
  if (reduces) {
    uvec2 from = local * 2;
    depth =
        average_depth(vec4(shared_depth[from.y][from.x], shared_depth[from.y][from.x + 1],
                           shared_depth[from.y + 1][from.x], shared_depth[from.y + 1][from.x + 1]),
                      reach);
  }
  barrier();
  if (reduces) {
    shared_depth[local.y][local.x] = depth;
  }
  return reduces;
}

bool inside(ivec2 texel, int mip) {
  return all(lessThan(texel, max(ivec2(parameters.projection.size_px) >> mip, ivec2(1))));
}

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  uvec2 local = gl_LocalInvocationID.xy;
  ivec2 group = ivec2(gl_WorkGroupID.xy);
  float depth = reduce_mip_0(texel);
  if (kMipCount > 1) {
    if (inside(texel, 1)) {
      imageStore(mip_1, texel, vec4(depth));
    }
    shared_depth[local.y][local.x] = depth;
  }
  if (kMipCount > 2 && reduce_shared(local, 4, parameters.reach * 2.0, depth)) {
    ivec2 target = group * 4 + ivec2(local);
    if (inside(target, 2)) {
      imageStore(mip_2, target, vec4(depth));
    }
  }
  if (kMipCount > 3 && reduce_shared(local, 2, parameters.reach * 4.0, depth)) {
    ivec2 target = group * 2 + ivec2(local);
    if (inside(target, 3)) {
      imageStore(mip_3, target, vec4(depth));
    }
  }
  if (kMipCount > 4 && reduce_shared(local, 1, parameters.reach * 8.0, depth)) {
    if (inside(group, 4)) {
      imageStore(mip_4, group, vec4(depth));
    }
  }
}
