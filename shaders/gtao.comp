#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Ground-truth ambient occlusion. Each traced pixel integrates the visible part of a few slices in
// closed form: above two horizons (gtao_horizons.h; Jimenez et al. 2016, section 4), or over the
// sectors that no occluder covers (gtao_bitmask.h, gtao_connected.h).
//
// Two sums over slices are written per traced pixel: the visible part, and the same without
// occluders. Filters and history sum both and divide at the end, because the mean of ratios would
// be biased. The bent-normal residual is a sum over slices too, in view space. With SPECULAR, the
// two sums of the surface's GGX lobe are also written.

#include "gtao_parameters.h"
#include "maths/bent_normal.h"
#include "maths/connected_samples.h"
#include "maths/gtao.h"
#include "maths/lobe_slice.h"
#include "maths/normal_encoding.h"
#include "maths/quantised_normal.h"
#include "maths/raw_occlusion.h"
#include "maths/sampling.h"
#include "maths/slice_line.h"
#include "maths/unobserved.h"
#include "maths/visibility_bitmask.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint kSliceCount = 1;
layout(constant_id = 1) const uint kStepCount = 12;
layout(constant_id = 2) const bool kBentNormal = false;
layout(constant_id = 3) const uint kEstimator = 0;  // as Estimator has them
layout(constant_id = 4) const int kTileSize = 1;    // one search a block of so many pixels a side
layout(constant_id = 5) const uint kPattern = 0;    // 0 golden, 1 Hilbert and R2, 2 the paper's
layout(constant_id = 6) const bool kPerspective = true;
layout(constant_id = 7) const bool kRoughnessTexture = false;
layout(constant_id = 8) const int kRoughnessChannel = 0;
layout(constant_id = 9) const bool kUniformWeight = false;
layout(constant_id = 10) const bool kFalloff = false;
layout(constant_id = 11) const bool kThicknessOfDistance = false;  // else of the radius
layout(constant_id = 12) const bool kBackFaces = false;  // tell the thickness, where there are any
layout(constant_id = 13) const bool kSnapToTexels = true;   // samples lie where their texels do
layout(constant_id = 14) const bool kSecondLayer = false;   // second_image occludes too
layout(constant_id = 15) const bool kExtrapolation = true;  // surfaces go on beyond the image
layout(constant_id = 16) const bool kUnobserved = true;     // is left out, with connected samples
layout(constant_id = 17) const uint kNormalEncoding = 0;    // as NormalEncoding has them
layout(constant_id = 18) const bool kReversed = false;      // raw depth is 1 at the near plane

const uint kBitmask = 2;
const uint kConnected = 3;
const bool kHeuristic = kEstimator == 1;
const bool kLeaveOutUnobserved = kEstimator == kConnected && kUnobserved;

layout(set = 0, binding = 0) uniform Parameters { GtaoParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D depth_image;   // as the projection wrote it
layout(set = 0, binding = 2) uniform texture2D normal_image;  // xyz, turned by view_from_normal
// Packed RawOcclusion and inverse depth; with SPECULAR also those of the GGX lobe and its surface.
layout(set = 0, binding = 3) uniform writeonly uimage2D raw_image;
// Bound to the raw occlusion and never written where no bent normal is wanted.
layout(set = 0, binding = 4) uniform writeonly uimage2D bent_image;
// Depth of the back faces. Without kBackFaces it is never read, and another image is bound in its
// place.
layout(set = 0, binding = 5) uniform texture2D back_image;
// The second depth layer. Without kSecondLayer it is never read, and another image is bound in its
// place.
layout(set = 0, binding = 6) uniform texture2D second_image;
#ifdef SPECULAR
layout(set = 0, binding = 7) uniform texture2D roughness_image;  // perceptual
const bool kLobe = true;
#else
const bool kLobe = false;
#endif

struct Surface {
  ivec2 pixel;
  float depth;
  float depth_step;  // of the depth buffer there, as SliceSample::inverse_depth
  vec3 normal;       // unit, view space
  vec3 view;         // unit, view space, towards the eye
  TangentPlane tangent;
  LobeSurface lobe;  // normal as it was given
};

ivec2 size_px() { return textureSize(depth_image, 0); }

float fetch_roughness(ivec2 pixel) {
#ifdef SPECULAR
  if (kRoughnessTexture) {
    return saturate(texelFetch(roughness_image, pixel, 0)[kRoughnessChannel]);
  }
#endif
  return parameters.roughness;
}

#include "load_depth.h"

float load_inverse_depth(ivec2 pixel) {
  return inverse_depth_of(texelFetch(depth_image, pixel, 0).r);
}

#include "depth_normal.h"

// In pixels.
vec2 centre_of(Surface surface) { return vec2(surface.pixel) + 0.5; }

Surface fetch_surface(ivec2 pixel, float inverse_depth) {
  Surface surface;
  surface.pixel = pixel;
  surface.depth = kPerspective ? 1.0 / inverse_depth : inverse_depth;
  surface.depth_step = depth_step_at(
      DepthStep(parameters.depth_step, parameters.depth_step_per_inverse_depth), inverse_depth);
  vec2 slope =
      parameters.slope.zw + (kPerspective ? centre_of(surface) * parameters.slope.xy : vec2(0.0));
  surface.view = normalize(vec3(-slope, 1.0));
  vec3 given = decode_normal(texelFetch(normal_image, pixel, 0).xyz, kNormalEncoding);
  surface.normal = seen_normal(pixel, mat3(parameters.view_from_normal) * given, surface.view);
  vec3 own = has_direction(given) ? given : surface.normal * mat3(parameters.view_from_normal);
  surface.lobe = LobeSurface(own, fetch_roughness(pixel));
  surface.tangent = make_tangent_plane(parameters.slope.xy, surface.normal, surface.view,
                                       surface.depth, kPerspective);
  surface.tangent.inverse_depth = inverse_depth;
  return surface;
}

// Sums over the half-slices of a slice.
struct SliceSum {
  float visible;   // visible part
  float left_out;  // part of it in unobserved directions
  vec2 bent;       // sum of visible directions: along the slice's direction, and the view's
  RawOcclusion lobe;
  float lobe_left_out;
};

RawOcclusion no_lobe() { return RawOcclusion(0.0, 0.0); }

#include "gtao_half_slice.h"

#include "gtao_bitmask.h"
#include "gtao_connected.h"
#include "gtao_horizons.h"

// The contribution of a slice to the pixel's sums.
struct SliceResult {
  RawOcclusion raw_occlusion;
  vec3 residual;
  vec3 expected_residual;
  RawOcclusion lobe;
};

RawOcclusion leave_out(RawOcclusion sum, float part) {
  return RawOcclusion(max(sum.visible - part, 0.0), sum.open - part);
}

// Searches both half-slices of a slice, and integrates what they leave visible.
SliceResult search_slice(Surface surface, vec3 direction, float step_offset) {
  Slice slice = make_slice(surface.normal, direction, surface.view);
  SliceLine slice_line = make_slice_line(parameters.slope.xy, direction, surface.view);
  LobeSlice lobe;
  if (kLobe) lobe = make_lobe_slice(slice, surface.lobe.roughness * surface.lobe.roughness);
  float radius_px = slice_radius_px(slice_line, parameters.radius, surface.depth, kPerspective);
  vec2 border_px = border_distances(centre_of(surface), slice_line.direction_px);
  vec2 open_arcs = kUniformWeight ? vec2(uniform_arc(tangent_light(slice, 1.0)),
                                         uniform_arc(tangent_light(slice, -1.0)))
                                  : tangent_arcs(slice);
  SliceSum sum = SliceSum(0.0, 0.0, vec2(0.0), no_lobe(), 0.0);
  uint i = 0u;
  [[dont_unroll]] do {
    float side = i == 0u ? 1.0 : -1.0;
    HalfSlice half_slice = make_half_slice(surface, slice_line, slice, side, radius_px,
                                           i == 0u ? border_px.x : border_px.y, step_offset);
    if (kEstimator == kConnected) {
      add_connected(sum, half_slice, slice, lobe, i == 0u ? open_arcs.x : open_arcs.y,
                    i == 0u ? border_px.y : border_px.x);
    } else if (kEstimator == kBitmask) {
      add_bitmask(sum, half_slice, slice, lobe);
    } else {
      add_horizon(sum, half_slice, slice, lobe);
    }
    ++i;
  }
  while (i < 2u)
    ;
  float open = open_arcs.x + open_arcs.y;
  SliceResult result;
  result.residual = vec3(0.0);
  result.expected_residual = vec3(0.0);
  if (kBentNormal) {
    vec3 part = direction * sum.bent.x + surface.view * sum.bent.y;
    result.residual = residual_of(part, sum.visible, surface.normal);
    result.expected_residual =
        expected_residual(slice, direction, surface.view, surface.normal, open);
  }
  result.raw_occlusion = leave_out(RawOcclusion(sum.visible, open), sum.left_out);
  result.lobe = no_lobe();
  if (kLobe) result.lobe = leave_out(RawOcclusion(sum.lobe.visible, lobe.open), sum.lobe_left_out);
  return result;
}

SliceNoise noise_at(uvec2 block) {
  switch (kPattern) {
    case 1:
      return hilbert_pattern(block, parameters.frame);
    case 2:
      return paper_pattern(block, parameters.frame);
    default:
      return golden_pattern(block, parameters.frame, kTileSize > 1);
  }
}

// Lobes of any width come to about as much: what neighbours of other roughness add is in scale.
uvec2 pack_scaled_lobe(LobeSurface surface, RawOcclusion lobe) {
  float scale = max(surface.roughness * surface.roughness, kSmallestLobe);
  lobe = RawOcclusion(lobe.visible * scale, lobe.open * scale);
  return uvec2(pack_lobe(lobe), pack_lobe_surface(surface));
}

RawOcclusion faded(RawOcclusion sum, float to_open) {
  return RawOcclusion(mix(sum.visible, sum.open, to_open), sum.open);
}

// Fades to open where the depth buffer cannot resolve the radius.
SliceResult fade_unresolved(SliceResult sum, float to_open) {
  sum.raw_occlusion = faded(sum.raw_occlusion, to_open);
  sum.residual = kBentNormal ? mix(sum.residual, sum.expected_residual, to_open) : vec3(0.0);
  if (kLobe) {
    sum.lobe = faded(sum.lobe, to_open);
  }
  return sum;
}

// What a search leaves at its block.
struct SearchResult {
  uvec4 raw_occlusion;
  uvec2 bent;
};

SearchResult sky_result() {
  return SearchResult(uvec4(pack_raw_occlusion(RawOcclusion(1.0, 1.0), 0u),
                            floatBitsToUint(sky_inverse_depth(kPerspective)), 0u, 0u),
                      uvec2(0u));
}

void add_slice(inout SliceResult sum, Surface surface, SliceNoise noise, uint i) {
  // Computed for each slice: six registers would otherwise be held through all of them.
  ViewBasis basis = make_view_basis(surface.view);
  WeightedAngle angle = WeightedAngle(slice_angle(i, kSliceCount, noise.direction), 1.0);
  if (kLobe) {
    angle = lobe_angle(angle.phi, lobe_plane(surface.normal, basis), surface.lobe.roughness);
  }
  SliceResult more = search_slice(surface, slice_direction(basis, angle.phi), noise.offset);
  sum.raw_occlusion.visible += angle.weight * more.raw_occlusion.visible;
  sum.raw_occlusion.open += angle.weight * more.raw_occlusion.open;
  sum.residual += angle.weight * more.residual;
  sum.expected_residual += angle.weight * more.expected_residual;
  sum.lobe.visible += angle.weight * more.lobe.visible;
  sum.lobe.open += angle.weight * more.lobe.open;
}

SearchResult search_pixel(ivec2 pixel, float inverse_depth, SliceNoise noise) {
  Surface surface = fetch_surface(pixel, inverse_depth);
  SliceResult sum = SliceResult(RawOcclusion(0.0, 0.0), vec3(0.0), vec3(0.0), no_lobe());
  if (kSliceCount == 1u) {
    add_slice(sum, surface, noise, 0u);
  } else {
    uint i = 0u;
    [[dont_unroll]] do {
      add_slice(sum, surface, noise, i);
      ++i;
    }
    while (i < kSliceCount)
      ;
  }
  float step_length = depth_step_length(surface.depth_step, inverse_depth, kPerspective);
  sum = fade_unresolved(sum, unresolved_occlusion(step_length, parameters.radius));
  float mean = 1.0 / float(kSliceCount);
  uvec2 lobe = kLobe ? pack_scaled_lobe(surface.lobe,
                                        RawOcclusion(sum.lobe.visible * mean, sum.lobe.open * mean))
                     : uvec2(0u);
  RawOcclusion raw_occlusion =
      RawOcclusion(sum.raw_occlusion.visible * mean, sum.raw_occlusion.open * mean);
  uint normal = make_quantised_normal(surface.normal).bits;
  return SearchResult(
      uvec4(pack_raw_occlusion(raw_occlusion, normal), floatBitsToUint(inverse_depth), lobe),
      kBentNormal
          ? uvec2(pack_residual(sum.residual * mean), pack_residual(sum.expected_residual * mean))
          : uvec2(0u));
}

void main() {
  ivec2 block = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(block * kTileSize, size_px()))) {
    return;
  }
  ivec2 pixel = min(block * kTileSize + ivec2(parameters.interleave_offset), size_px() - 1);
  float inverse_depth = load_inverse_depth(pixel);
  SearchResult result = sky_result();
  if (inverse_depth != sky_inverse_depth(kPerspective)) {
    result = search_pixel(pixel, inverse_depth, noise_at(uvec2(block)));
  }
  imageStore(raw_image, block, result.raw_occlusion);
  if (kBentNormal) {
    imageStore(bent_image, block, uvec4(result.bent, 0u, 0u));
  }
}
