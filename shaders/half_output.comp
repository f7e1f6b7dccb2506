#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Writes the results of the reconstruction at half resolution into images of half the depth
// buffer's size, for engines that upsample these themselves. It runs instead of upsample.comp.

#include "depth_normal.h"
#include "maths/bent_normal.h"
#include "maths/half_texel.h"
#include "maths/history.h"
#include "maths/normal_encoding.h"
#include "maths/raw_occlusion.h"
#include "store_visibility.h"
#include "upsample_parameters.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool kPerspective = true;
layout(constant_id = 1) const bool kVisibility = true;  // whether visibility_image is written
layout(constant_id = 2) const bool kShaped = false;     // power or intensity is not 1
layout(constant_id = 3) const bool kBentNormal = false;
layout(constant_id = 4) const uint kNormalEncoding = 0;  // as NormalEncoding has them
layout(constant_id = 5) const bool kReversed = false;    // raw depth is 1 at the near plane
// Writes visibility to the channel kVisibilityChannel alone and keeps the others.
layout(constant_id = 6) const bool kKeepsChannels = false;
layout(constant_id = 7) const int kVisibilityChannel = 0;
layout(constant_id = 8) const bool kAreas = false;  // images are read or written in part (areas.h)

layout(set = 0, binding = 0) uniform Parameters { UpsampleParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D half_image;    // pack_half_texel()
layout(set = 0, binding = 2) uniform texture2D depth_image;   // as the projection wrote it
layout(set = 0, binding = 3) uniform texture2D normal_image;  // xyz
// pack_half_residual(). Without bent normals it is never read, and another image is bound.
layout(set = 0, binding = 4) uniform texture2D residual_image;
// The next two are each bound to another image if they are not written.
layout(set = 0, binding = 5) uniform writeonly image2D visibility_image;
// In the space of the normals.
layout(set = 0, binding = 6) uniform writeonly image2D bent_normal_image;
// The same image as visibility_image, bound for reading the channels that keep their contents. It
// is read only with kKeepsChannels; otherwise another image is bound in its place.
layout(set = 0, binding = 7) uniform texture2D kept_image;
#ifdef SPECULAR
layout(set = 0, binding = 8) uniform utexture2D lobe_image;  // LobeTexel
layout(set = 0, binding = 9) uniform writeonly image2D specular_image;
#endif

#define WRITES_OUTPUTS
#include "areas.h"

// Returns the pixel that represents a texel, to whose surface the results belong.
ivec2 pixel_of(ivec2 texel) {
  ivec2 first = texel * 2;
  ivec2 last = min(first + 1, size_px() - 1);
  ivec2 pixels[4] = ivec2[](first, ivec2(first.x, last.y), ivec2(last.x, first.y), last);
  vec4 depths;
  for (int i = 0; i < 4; ++i) depths[i] = fetch_depth(pixels[i]);
  float chosen = representative_depth(texel, depths, kReversed);
  return depths.x == chosen   ? pixels[0]
         : depths.y == chosen ? pixels[1]
         : depths.z == chosen ? pixels[2]
                              : pixels[3];
}

vec3 unit_normal(ivec2 pixel) {
  vec2 slope =
      parameters.slope.zw + (kPerspective ? (vec2(pixel) + 0.5) * parameters.slope.xy : vec2(0.0));
  vec3 given = decode_normal(texelFetch(normal_image, in_inputs(pixel), 0).xyz, kNormalEncoding) *
               mat3(parameters.normal_from_view);
  vec3 view = normalize(vec3(-slope, 1.0));
  vec3 of_depth = vec3(0.0);
  if (needs_depth_normal(given, view)) {
    of_depth = depth_buffer_normal(
        fetch_depth_cross(depth_image, pixel, in_inputs(ivec2(0)), size_px()), pixel, size_px(),
        parameters.slope, parameters.inverse_depth_from_ndc, kPerspective, kReversed);
  }
  return seen_normal(given, view, of_depth);
}

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy) + first_written() / 2;
  if (any(greaterThan(texel * 2, last_written()))) return;
  // The sky has no occlusion, no residual and no occluded lobe.
  float visibility = saturate(1.0 - texelFetch(half_image, texel, 0).r);
  if (kVisibility) {
    float shaped = shaped_visibility(visibility, parameters.power, parameters.intensity);
    imageStore(visibility_image, in_outputs(texel),
               visibility_texel(kShaped ? shaped : visibility, kKeepsChannels, kVisibilityChannel,
                                kept_image, in_outputs(texel)));
  }
  if (kBentNormal) {
    vec3 residual = unpack_half_residual(texelFetch(residual_image, texel, 0).xyz);
    vec3 bent = finish_bent_normal(residual, visibility, unit_normal(pixel_of(texel)));
    imageStore(bent_normal_image, in_outputs(texel),
               vec4(mat3(parameters.normal_from_view) * bent, 0.0));
  }
#ifdef SPECULAR
  LobeTexel lobe = unpack_lobe_texel(texelFetch(lobe_image, texel, 0).r);
  imageStore(specular_image, in_outputs(texel), vec4(1.0 - lobe.occlusion));
#endif
}
