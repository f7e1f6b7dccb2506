#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Ground-truth ambient occlusion [Jimenez 2016, equation 2]. Each traced pixel searches the depth
// buffer in a few slices, and integrates the visible part of each slice in closed form. Sections
// below are those of the paper. Functions are defined before their use, so read main() first:
//   main            the traced pixel of a tile                           section 4.4
//   search_pixel    the outer integral, a mean over slices               section 4.1
//     fetch_surface     position, normal, view direction                 gtao_surface.h
//     add_slice         a slice, rotated by the noise                    section 4.4
//       search_slice    the inner integral, a sum of two half-slices     section 4.1
//         make_half_slice   depth samples along the slice's line         gtao_search_line.h
//         add_connected     occluders, and the closed form between them  gtao_connected.h
//     fade_unresolved   where depth has too few steps for the radius
//   imageStore      the packed sums                                      maths/raw_occlusion.h
// With kHorizons, the paper's estimator takes the place of gtao_connected.h (section 4.1,
// gtao_horizons.h).
//
// Each traced pixel writes two sums over its slices: the visible part, and the same integral
// without occluders. Filters and history sum both and divide at the end, because the mean of ratios
// would be biased. With BENT, the bent-normal residual is also a sum over slices, in view space.
// With SPECULAR, the two sums of the surface's GGX lobe are also written.

#include "gtao_connected.h"
#include "gtao_horizons.h"
#include "gtao_surface.h"
#include "maths/bent_normal.h"
#include "maths/gtao.h"
#include "maths/lobe_slice.h"
#include "maths/quantised_normal.h"
#include "maths/raw_occlusion.h"
#include "maths/sampling.h"
#include "maths/slice.h"

layout(local_size_x = 8, local_size_y = 8) in;

// The contribution of a slice to the pixel's sums.
struct SliceResult {
  RawOcclusion raw_occlusion;
  vec3 residual;
  vec3 expected_residual;
  RawOcclusion lobe;
};

const SliceResult kNoResult =
    SliceResult(RawOcclusion(0.0, 0.0), vec3(0.0), vec3(0.0), RawOcclusion(0.0, 0.0));

RawOcclusion not_negative(RawOcclusion sum) {
  return RawOcclusion(max(sum.visible, 0.0), sum.open);
}

// Searches both half-slices of a slice, and integrates their visible parts: the inner integral of
// [Jimenez 2016, section 4.1].
SliceResult search_slice(Surface surface, vec3 direction, float step_offset) {
  Slice slice = make_slice(surface.normal, direction, surface.view);
  SearchLine search_line = make_search_line(surface, direction);
  vec2 border = border_offsets(surface, search_line);
  SliceSum sum = no_sum(surface);
  // With `for`, this loop and that over slices need up to 128 registers instead of 80 (RDNA2), and
  // llvmpipe draws another picture from the translated GLSL of the latter.
  uint i = 0u;
  [[dont_unroll]] do {
    float side = i == 0u ? 1.0 : -1.0;
    HalfSlice half_slice = make_half_slice(surface, search_line, slice, side, border, step_offset);
    if (kHorizons)
      add_horizons(sum, half_slice, slice);
    else
      add_connected(sum, half_slice, slice);
    search_line = opposite(search_line);
    border = border.yx;
    ++i;
  }
  while (i < 2u)
    ;
  SliceResult result = kNoResult;
  if (kBentNormal) {
    vec3 part = direction * sum.bent.x + surface.view * sum.bent.y;
    result.residual = residual_of(part, sum.visible, surface.normal);
    result.expected_residual = expected_residual(slice, direction, surface.view, surface.normal,
                                                 kUniform ? 1.0 : open_slice(slice));
  }
  result.raw_occlusion = not_negative(sum.raw_occlusion);
  if (kLobe) result.lobe = not_negative(sum.lobe);
  return result;
}

RawOcclusion scaled(RawOcclusion sum, float factor) {
  return RawOcclusion(sum.visible * factor, sum.open * factor);
}

// Packs the sums of a lobe, scaled so that sums of narrow and of wide lobes have about the same
// size. Neighbours of different roughness can then be averaged.
uvec2 pack_scaled_lobe(Surface surface, RawOcclusion lobe) {
  float scale = max(surface.roughness * surface.roughness, kSmallestLobe);
  return uvec2(pack_lobe(scaled(lobe, scale)), surface.lobe_surface);
}

// `to_open` is 0 for the sums as they are and 1 for those of an unoccluded surface.
RawOcclusion faded(RawOcclusion sum, float to_open) {
  return RawOcclusion(mix(sum.visible, sum.open, to_open), sum.open);
}

// Fades the sums to unoccluded ones if the depth buffer cannot resolve the radius.
SliceResult fade_unresolved(SliceResult sum, float to_open) {
  sum.raw_occlusion = faded(sum.raw_occlusion, to_open);
  sum.residual = kBentNormal ? mix(sum.residual, sum.expected_residual, to_open) : vec3(0.0);
  if (kLobe) sum.lobe = faded(sum.lobe, to_open);
  return sum;
}

// The packed results of a traced pixel.
struct SearchResult {
  uvec4 raw_occlusion;
  uvec2 bent;
};

// The result of a pixel that shows the sky.
SearchResult sky_result() {
  return SearchResult(uvec4(pack_raw_occlusion(RawOcclusion(1.0, 1.0), 0u),
                            floatBitsToUint(sky_inverse_depth(kPerspective)), 0u, 0u),
                      uvec2(0u));
}

// Adds slice `i` to the sums, with the weight of its angle. Slices contain the view direction, and
// the noise rotates them (section 4.4).
void add_slice(inout SliceResult sum, Surface surface, SliceNoise noise, uint i) {
  ViewBasis basis = make_view_basis(surface.view);
  WeightedAngle angle = WeightedAngle(slice_angle(i, kSliceCount, noise.direction), 1.0);
  if (kLobe) angle = lobe_angle(angle.phi, lobe_plane(surface.normal, basis), surface.roughness);
  SliceResult slice = search_slice(surface, slice_direction(basis, angle.phi), noise.offset);
  sum.raw_occlusion.visible += slice.raw_occlusion.visible * angle.weight;
  sum.raw_occlusion.open += slice.raw_occlusion.open * angle.weight;
  sum.residual += slice.residual * angle.weight;
  sum.expected_residual += slice.expected_residual * angle.weight;
  sum.lobe.visible += slice.lobe.visible * angle.weight;
  sum.lobe.open += slice.lobe.open * angle.weight;
}

// The step of the depth buffer at a surface, in scene units. The order of the operations differs
// from that of make_search_line(), because a common value would hold a register during the search.
float depth_step_length(Surface surface) {
  float constant = parameters.depth_step;
  float per_inverse_depth = parameters.depth_step_per_inverse_depth;
  return kPerspective ? max((constant * surface.depth + per_inverse_depth) * surface.depth, 0.0)
                      : max(constant + per_inverse_depth * surface.depth, 0.0);
}

// Searches all slices of a pixel that is not the sky: the outer integral of section 4.1, a mean
// over the angles of the slices.
SearchResult search_pixel(ivec2 pixel, float inverse_depth, SliceNoise noise) {
  Surface surface = fetch_surface(pixel, inverse_depth);
  SliceResult sum = kNoResult;
  if (!kLobe && !reaches_samples(surface)) {
    // Without occluders, the mean of a slice over all directions is 1.
    sum.raw_occlusion = RawOcclusion(float(kSliceCount), float(kSliceCount));
  } else {
    uint i = 0u;
    [[dont_unroll]] do {
      add_slice(sum, surface, noise, i);
      if (kSliceCount == 1u) break;  // compilers then remove the loop
      ++i;
    }
    while (i < kSliceCount)
      ;
  }
  sum = fade_unresolved(sum, unresolved_occlusion(depth_step_length(surface), parameters.radius));
  float mean = 1.0 / float(kSliceCount);
  uvec2 lobe = kLobe ? pack_scaled_lobe(surface, scaled(sum.lobe, mean)) : uvec2(0u);
  uint normal = quantise_normal(surface.normal);
  return SearchResult(uvec4(pack_raw_occlusion(scaled(sum.raw_occlusion, mean), normal),
                            floatBitsToUint(inverse_depth), lobe),
                      kBentNormal ? uvec2(pack_residual(sum.residual * mean),
                                          pack_residual(sum.expected_residual * mean))
                                  : uvec2(0u));
}

// Groups run in the order of their numbers, x first. They advance by columns through strips of the
// image that are strip_groups high, so that groups that run at the same time lie close together and
// share what caches hold.
ivec2 invocation_tile() {
  uint row = gl_WorkGroupID.z * parameters.strip_groups + gl_WorkGroupID.x;
  ivec2 tile = ivec2(uvec2(gl_WorkGroupID.y, row) * 8u + gl_LocalInvocationID.xy);
  return kAreas ? tile + parameters.written.xy : tile;
}

void main() {
  ivec2 tile = invocation_tile();
  if (any(kAreas ? greaterThan(tile, parameters.written.zw)
                 : greaterThanEqual(tile * kTileSize, size_px())))
    return;
  ivec2 pixel = min(tile * kTileSize + ivec2(parameters.interleave_offset), size_px() - 1);
  float inverse_depth = load_inverse_depth(pixel);
  SearchResult result = sky_result();
  if (inverse_depth != sky_inverse_depth(kPerspective)) {
    result = search_pixel(pixel, inverse_depth,
                          golden_pattern(uvec2(tile), parameters.frame, kTileSize > 1));
  }
  // The tile is computed anew, because it would hold registers during the search.
  ivec2 written = ivec2(uvec2(pixel) / uint(kTileSize));
  imageStore(raw_image, written, result.raw_occlusion);
#ifdef BENT
  imageStore(bent_image, written, uvec4(result.bent, 0u, 0u));
#endif
}
