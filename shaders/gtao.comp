#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Ground-truth ambient occlusion: per pixel a few slices around the view vector, in each the two
// horizons of the depth buffer, integrated in closed form. Jimenez et al. 2016, section 4.
//
// Writes two numbers a pixel, the visible part of its slices and the whole of them when open: filters
// and history add up each, and only the last divides. The mean of the pixels' own ratios would be
// biased. The bent normal is written as a sum over slices too, in view space, and never normalised.

#include "gtao_parameters.h"
#include "maths/bent_normal.h"
#include "maths/connected_samples.h"
#include "maths/gtao.h"
#include "maths/sampling.h"
#include "maths/slice_line.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint kSliceCount = 1;
layout(constant_id = 1) const uint kStepCount = 12;
layout(constant_id = 2) const bool kBentNormal = false;
layout(constant_id = 3) const bool kBitmask = false;
layout(constant_id = 4) const int kDivisor = 1;  // one search a block of so many pixels a side
layout(constant_id = 5) const uint kPattern = 0;  // 0 golden, 1 Hilbert and R2, 2 the memo's

layout(set = 0, binding = 0) uniform Parameters { GtaoParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D depth_image;   // linear
layout(set = 0, binding = 2) uniform texture2D normal_image;  // xyz, turned by view_from_normal
layout(set = 0, binding = 3) uniform writeonly image2D signal_image;  // visible, open
// Bound to the signal and never written where no bent normal is wanted.
layout(set = 0, binding = 4) uniform writeonly image2D bent_image;

struct Surface {
  vec2 pixel;  // centre, pixels
  float depth;
  vec3 normal;  // unit, view space
  vec3 view;    // unit, view space, towards the eye
};

Surface fetch_surface(ivec2 pixel, float depth) {
  Surface surface;
  surface.pixel = vec2(pixel) + 0.5;
  surface.depth = depth;
  vec2 uv = surface.pixel * parameters.projection.texel_uv;
  surface.view = view_vector(parameters.projection, position_vs(parameters.projection, uv, depth));
  vec3 normal = mat3(parameters.view_from_normal) * texelFetch(normal_image, pixel, 0).xyz;
  surface.normal = facing_normal(normalize(normal), surface.view);
  return surface;
}

// Pixels from the surface to the border of the image along a direction.
float border_distance(vec2 pixel, vec2 direction) {
  vec2 border = mix(vec2(0.0), parameters.projection.size_px, greaterThan(direction, vec2(0.0)));
  vec2 distance = (border - pixel) / direction;
  return min(direction.x != 0.0 ? distance.x : 1e9, direction.y != 0.0 ? distance.y : 1e9) - 0.01;
}

// How far to search on one side, in pixels. Where the surface faces away from a side, what stands
// above its tangent plane within the radius lies nearer by the cosine of gamma.
float search_distance(Surface surface, SliceLine line, Slice slice, float side) {
  float reach = tangent_horizon(slice, side) > 0.0 ? slice.cosine : 1.0;
  float radius_px =
      slice_radius_px(parameters.projection, line, parameters.radius * reach, surface.depth);
  return min(radius_px, border_distance(surface.pixel, side * line.direction_px));
}

// Cosine of the highest horizon within the radius on one side; -1 where there is none.
float find_horizon(Surface surface, SliceLine line, Slice slice, float side, float offset) {
  float horizon = -1.0;
  float distance_px = search_distance(surface, line, slice, side);
  if (distance_px < kNearestStep) {
    return horizon;
  }
  vec2 direction = side * line.direction_px;
  float radius_squared = parameters.radius * parameters.radius;
  for (uint k = 0; k < kStepCount; ++k) {
    float step_px = step_distance_squared(k, kStepCount, offset, distance_px);
    vec2 texel = floor(surface.pixel + direction * step_px);
    float depth = texelFetch(depth_image, ivec2(texel), 0).r;
    vec2 point = slice_point(line, texel + 0.5 - surface.pixel, depth, surface.depth,
                             sample_scale(parameters.projection, depth));
    float squared = dot(point, point);
    if (squared <= radius_squared && side * point.x > 0.0) {
      horizon = max(horizon, point.y * inversesqrt(max(squared, 1e-30)));
    }
  }
  return horizon;
}

// A sample of a side, as the bitmask wants it.
struct Occluder {
  LineSample on_line;
  vec2 point;  // in the plane of the slice, scene units
};

Occluder fetch_occluder(Surface surface, SliceLine line, vec2 direction, float step_px) {
  vec2 texel = floor(surface.pixel + direction * step_px);
  float depth = texelFetch(depth_image, ivec2(texel), 0).r;
  Occluder occluder;
  occluder.on_line.offset_px = step_px;
  occluder.on_line.line = parameters.projection.eye.w > 0.0 ? 1.0 / depth : depth;
  occluder.point = slice_point(line, texel + 0.5 - surface.pixel, depth, surface.depth,
                               sample_scale(parameters.projection, depth));
  return occluder;
}

float position_of(Slice slice, SectorScale scale, float side, vec2 point) {
  float cosine = point.y * inversesqrt(max(dot(point, point), 1e-30));
  return sector_position(slice, scale, side, cosine);
}

struct SideOcclusion {
  uint sectors;   // occluded ones
  float highest;  // position of the occluder nearest to the view vector; the tangent plane's without
};

SideOcclusion find_occluders(Surface surface, SliceLine line, Slice slice, SectorScale scale,
                             float side, float offset) {
  SideOcclusion found;
  found.sectors = 0u;
  found.highest = side > 0.0 ? 1.0 : 0.0;
  float distance_px = search_distance(surface, line, slice, side);
  if (distance_px < kNearestStep) {
    return found;
  }
  vec2 direction = side * line.direction_px;
  bool perspective = parameters.projection.eye.w > 0.0;
  float per_px = abs(line.x_per_step);
  float radius_squared = parameters.radius * parameters.radius;
  float towards_eye = perspective ? 1.0 / (surface.depth * line.y_per_depth) : 0.0;

  Occluder before;
  before.on_line.offset_px = 0.0;
  before.on_line.line = perspective ? 1.0 / surface.depth : surface.depth;
  before.point = vec2(0.0);
  Occluder last = before;
  float last_position = found.highest;
  Occluder here = fetch_occluder(surface, line, direction,
                                 step_distance_squared(0, kStepCount, offset, distance_px));
  for (uint k = 0; k < kStepCount; ++k) {
    Occluder next = here;
    if (k + 1 < kStepCount) {
      next = fetch_occluder(surface, line, direction,
                            step_distance_squared(k + 1, kStepCount, offset, distance_px));
      next.on_line.offset_px = max(next.on_line.offset_px, here.on_line.offset_px + 0.25);
    }
    float step_px = here.on_line.offset_px - last.on_line.offset_px;
    float tolerance =
        2.0 * per_px * (perspective ? min(here.on_line.line, last.on_line.line) : 1.0);
    bool joined = k > 0 && (k + 1 < kStepCount
                                ? samples_connect(before.on_line, last.on_line, here.on_line,
                                                  next.on_line, tolerance)
                                : abs(extrapolate(before.on_line, last.on_line,
                                                  here.on_line.offset_px) -
                                      here.on_line.line) < tolerance * step_px);
    bool inside = dot(here.point, here.point) <= radius_squared && side * here.point.x > 0.0;
    vec2 front = here.point;
    if (!joined) {
      front.x *= 1.0 - edge_share(kStepCount) * step_px / here.on_line.offset_px;
    }
    float position = position_of(slice, scale, side, front);
    if (inside) {
      vec2 behind = here.point + parameters.thickness * vec2(here.point.x * towards_eye, -1.0);
      float covered = position_of(slice, scale, side, behind);
      float low = min(position, covered);
      float high = max(position, covered);
      if (joined) {
        low = min(low, last_position);
        high = max(high, last_position);
      }
      found.sectors |= cover_sectors(low, high, 0.5);
      found.highest = side > 0.0 ? min(found.highest, low) : max(found.highest, high);
    }
    before = last;
    last = here;
    last_position = position;
    here = next;
  }
  return found;
}

SliceNoise noise_at(uvec2 block) {
  switch (kPattern) {
    case 1:
      return hilbert_noise(block, parameters.frame);
    case 2:
      return spatial_pattern(block, parameters.frame);
    default:
      return golden_pattern(block, parameters.frame);
  }
}

void main() {
  ivec2 block = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = ivec2(parameters.projection.size_px);
  if (any(greaterThanEqual(block * kDivisor, size))) {
    return;
  }
  ivec2 pixel = min(block * kDivisor + ivec2(parameters.phase), size - 1);
  float depth = texelFetch(depth_image, pixel, 0).r;
  if (is_sky_depth(depth)) {
    imageStore(signal_image, block, vec4(1.0));
    if (kBentNormal) {
      imageStore(bent_image, block, vec4(0.0));
    }
    return;
  }
  Surface surface = fetch_surface(pixel, depth);
  ViewBasis basis = make_view_basis(surface.view);
  vec2 per_px = ray_per_px(parameters.projection);
  SliceNoise noise = noise_at(uvec2(block));

  float visibility = 0.0;
  float weight = 0.0;
  vec3 bent = vec3(0.0);
  for (uint i = 0; i < kSliceCount; ++i) {
    vec3 direction = slice_direction(basis, slice_angle(i, kSliceCount, noise.direction));
    Slice slice = make_slice(surface.normal, direction, surface.view);
    SliceLine line = make_slice_line(per_px, surface.normal, direction, surface.view);
    if (kBitmask) {
      SectorScale scale = make_sector_scale(slice);
      SideOcclusion front = find_occluders(surface, line, slice, scale, 1.0, noise.offset);
      SideOcclusion back = find_occluders(surface, line, slice, scale, -1.0, noise.offset);
      float thin = bitmask_visibility(scale, front.sectors | back.sectors);
      float thick = scale.open * max(front.highest - back.highest, 0.0);
      visibility += mix(thin, thick, parameters.fill);
      weight += scale.open;
      continue;
    }
    float ahead = find_horizon(surface, line, slice, 1.0, noise.offset);
    float behind = find_horizon(surface, line, slice, -1.0, noise.offset);
    visibility += slice_visibility(slice, ahead, behind);
    weight += open_slice(slice);
    if (kBentNormal) {
      bent += slice_bent_normal(slice, direction, surface.view, ahead, behind);
    }
  }
  float mean = 1.0 / float(kSliceCount);
  imageStore(signal_image, block, vec4(visibility * mean, weight * mean, 0.0, 0.0));
  if (kBentNormal) {
    imageStore(bent_image, block, vec4(bent * mean, 0.0));
  }
}
