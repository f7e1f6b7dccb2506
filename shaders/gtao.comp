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
#include "maths/bitmask_bent_normal.h"
#include "maths/connected_samples.h"
#include "maths/gtao.h"
#include "maths/sampling.h"
#include "maths/signal.h"
#include "maths/slice_line.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint kSliceCount = 1;
layout(constant_id = 1) const uint kStepCount = 12;
layout(constant_id = 2) const bool kBentNormal = false;
layout(constant_id = 3) const bool kBitmask = false;
layout(constant_id = 4) const int kDivisor = 1;  // one search a block of so many pixels a side
layout(constant_id = 5) const uint kPattern = 0;  // 0 golden, 1 Hilbert and R2, 2 the memo's
layout(constant_id = 6) const bool kPerspective = true;
layout(constant_id = 7) const bool kReversed = false;

// Bend of the line between two samples, in depths for each pixel's width, that parts two surfaces.
const float kSharpBend = 4.0;

layout(set = 0, binding = 0) uniform Parameters { GtaoParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D depth_image;   // as the projection wrote it
layout(set = 0, binding = 2) uniform texture2D normal_image;  // xyz, turned by view_from_normal
layout(set = 0, binding = 3) uniform writeonly uimage2D signal_image;  // signal, line
// Bound to the signal and never written where no bent normal is wanted.
layout(set = 0, binding = 4) uniform writeonly uimage2D bent_image;

struct Surface {
  ivec2 pixel;
  vec2 centre;  // of the pixel, pixels
  float depth;
  vec3 normal;  // unit, view space
  vec3 view;    // unit, view space, towards the eye
  TangentLine tangent;
};

ivec2 size_px() { return textureSize(depth_image, 0); }

// As is_sky_ndc() has it.
bool is_sky(float ndc) { return kReversed ? !(ndc > 0.0) : !(ndc < 1.0); }

const float kSkyLine = kPerspective ? 1.0 / kSkyDepth : kSkyDepth;

// `line` of the image at a pixel; the sky's where the depth is the far plane's.
float fetch_line(ivec2 pixel) {
  float ndc = texelFetch(depth_image, pixel, 0).r;
  float line = parameters.line_from_ndc.x * ndc + parameters.line_from_ndc.y;
  return is_sky(ndc) ? kSkyLine : line;
}

float depth_of_line(float line) { return kPerspective ? 1.0 / line : line; }

Surface fetch_surface(ivec2 pixel, float line) {
  Surface surface;
  surface.pixel = pixel;
  surface.centre = vec2(pixel) + 0.5;
  surface.depth = depth_of_line(line);
  vec2 slope = parameters.slope.zw + (kPerspective ? surface.centre * parameters.slope.xy : vec2(0.0));
  surface.view = normalize(vec3(-slope, 1.0));
  vec3 normal = mat3(parameters.view_from_normal) * texelFetch(normal_image, pixel, 0).xyz;
  surface.normal = facing_normal(normalize(normal), surface.view);
  surface.tangent = make_tangent_line(parameters.slope.xy, surface.normal, surface.view,
                                      surface.depth, kPerspective);
  return surface;
}

// Pixels from the surface to the border of the image along a direction.
float border_distance(vec2 centre, vec2 direction) {
  vec2 border = mix(vec2(0.0), vec2(size_px()), greaterThan(direction, vec2(0.0)));
  vec2 distance = (border - centre) / direction;
  return min(direction.x != 0.0 ? distance.x : 1e9, direction.y != 0.0 ? distance.y : 1e9) - 0.01;
}

// How far to search on one side, in pixels. Where the surface faces away from a side, what stands
// above its tangent plane within the radius lies nearer by the cosine of gamma.
float search_distance(Surface surface, SliceLine line, Slice slice, float side) {
  float reach = tangent_horizon(slice, side) > 0.0 ? slice.cosine : 1.0;
  return slice_radius_px(line, parameters.radius * reach, surface.depth, kPerspective);
}

// One side of a slice, as it is searched.
struct Search {
  SliceLine line;
  ivec2 pixel;
  vec2 direction_px;  // outwards; 0 where there is nothing to search
  float side;
  float reach_px;  // from the first step to the last
  float offset;    // of the steps, [0,1)
  float depth;     // linear, of the shaded point
  TangentLine tangent;
};

Search make_search(Surface surface, SliceLine line, Slice slice, float side, float offset) {
  vec2 direction = side * line.direction_px;
  float border = border_distance(surface.centre, direction);
  float distance_px = search_distance(surface, line, slice, side);
  Search search;
  search.line = line;
  search.pixel = surface.pixel;
  search.direction_px = min(distance_px, border) < kNearestStep ? vec2(0.0) : direction;
  search.side = side;
  // Steps stay apart where the radius spans few pixels, and inside the image always.
  float apart = max(distance_px - kNearestStep, 0.25 * float(kStepCount));
  search.reach_px = max(min(apart, border - kNearestStep), 1e-3);
  search.offset = offset;
  search.depth = surface.depth;
  search.tangent = surface.tangent;
  return search;
}

LineSample fetch_sample(Search search, uint k) {
  float t = (float(k) + search.offset) * (1.0 / float(kStepCount));
  LineSample found;
  found.offset_px = kNearestStep + search.reach_px * t * t;
  vec2 exact = search.direction_px * found.offset_px;
  vec2 snapped = roundEven(exact);
  float line = fetch_line(search.pixel + ivec2(snapped));
  found.share = 1.0 / found.offset_px;
  // Only across the line: along it a sample stays where it was found.
  float along_px = dot(snapped, search.line.direction_px);
  vec2 moved = tangent_share(search.tangent, snapped, line, found.share) *
               (search.line.direction_px * along_px - snapped);
  found.line = max(line + dot(moved, search.tangent.gradient), 0.1 * line);
  float depth = depth_of_line(found.line);
  found.point =
      slice_point(search.line, along_px, depth, search.depth, kPerspective ? depth : 1.0);
  found.point.x *= search.side;
  return found;
}

bool within_radius(float squared) { return squared <= parameters.radius * parameters.radius; }

// Cosine of the highest horizon within the radius on one side; -1 where there is none.
float find_horizon(Search search) {
  float horizon = -1.0;
  for (uint k = 0; k < kStepCount; ++k) {
    vec2 point = fetch_sample(search, k).point;
    float squared = dot(point, point);
    float cosine = point.y * inversesqrt(max(squared, 1e-30));
    horizon = within_radius(squared) ? max(horizon, cosine) : horizon;
  }
  return search.direction_px == vec2(0.0) ? -1.0 : horizon;
}

// A side of a slice as the bitmask sees it.
struct Side {
  float height_per_x;  // above the tangent plane, of a point of the slice's plane
  float height_per_y;
  float sharp;         // bend that parts two surfaces
  EdgeScale edges;
};

Side make_side(Surface surface, SliceLine line, Slice slice, SectorScale scale, float side) {
  Side made;
  made.height_per_x = side * slice.along;
  made.height_per_y = slice.toward;
  made.sharp = kSharpBend * line.x_per_step * (kPerspective ? surface.tangent.line : 1.0);
  made.edges = make_edge_scale(slice, scale, side);
  return made;
}

// What the search holds on to from sample to sample.
struct Sheet {
  LineSample last;
  float slope;      // of `line` up to the last sample
  float bend;       // at the last sample
  float position;   // of the last sample's front
  float distance;   // its distance from the shaded point
  bool inside;      // whether it lies within the radius, on this side
  uint sectors;     // occluded so far
};

float back_position(Side side, LineSample here) {
  return edge_position(side.edges, here.point - vec2(0.0, parameters.thickness));
}

// The first sample stands alone. Its edge is drawn in unless it lies on the surface's own plane.
Sheet begin_sheet(Surface surface, Side side, LineSample here, LineSample next) {
  Sheet sheet;
  sheet.last = here;
  sheet.slope = line_slope(here, next);
  sheet.bend = (here.line - surface.tangent.line) * here.share - sheet.slope;
  float squared = dot(here.point, here.point);
  sheet.distance = sqrt(squared);
  sheet.inside = within_radius(squared);
  float height = dot(here.point, vec2(side.height_per_x, side.height_per_y));
  bool above = height * abs(height) > 0.04 * squared;
  vec2 front = vec2(here.point.x * (above ? 1.0 - edge_share(kStepCount) : 1.0), here.point.y);
  sheet.position = edge_position(side.edges, front);
  uint covered = sectors_between(sheet.position, back_position(side, here));
  sheet.sectors = sheet.inside ? covered : 0u;
  return sheet;
}

// Adds a sample, `bend` of the line at it: its thickness, and the sheet between it and the last one
// if they are joined, each as far as it lies within the radius.
void extend_sheet(inout Sheet sheet, Side side, LineSample here, float bend) {
  bool joined = samples_join(sheet.bend, bend, side.sharp);
  float squared = dot(here.point, here.point);
  bool inside = within_radius(squared);
  float step_px = here.offset_px - sheet.last.offset_px;
  float drawn = joined ? 0.0 : edge_share(kStepCount) * step_px * here.share;
  float position =
      edge_position(side.edges, vec2(here.point.x * (1.0 - drawn), here.point.y));
  float distance = sqrt(squared);
  vec2 crossing = radius_crossing(here.point, distance, sheet.last.point, sheet.distance,
                                  parameters.radius);
  float cut = edge_position(side.edges, crossing);
  float start = inside ? position : cut;
  float end = inside ? back_position(side, here) : cut;
  float low = min(start, end);
  float high = max(start, end);
  float joint = joined ? (sheet.inside ? sheet.position : cut) : start;
  uint covered = sectors_between(min(low, joint), max(high, joint));
  sheet.sectors |= inside || (joined && sheet.inside) ? covered : 0u;
  sheet.last = here;
  sheet.bend = bend;
  sheet.position = position;
  sheet.distance = distance;
  sheet.inside = inside;
}

// The sectors that the samples of a side occlude. Each sample waits for the next one, which tells
// how the line bends at it.
uint find_occluders(Surface surface, Search search, Side side) {
  LineSample here = fetch_sample(search, 1);
  Sheet sheet = begin_sheet(surface, side, fetch_sample(search, 0), here);
  for (uint k = 2; k < kStepCount; ++k) {
    LineSample next = fetch_sample(search, k);
    float slope = line_slope(here, next);
    float bend = sheet.slope - slope;
    extend_sheet(sheet, side, here, bend);
    sheet.slope = slope;
    here = next;
  }
  // Nothing tells how it ends: joined only if the way to it did not bend.
  extend_sheet(sheet, side, here, -1e30 * sheet.bend);
  return search.direction_px == vec2(0.0) ? 0u : sheet.sectors;
}

// What a slice adds to the pixel's sums.
struct SliceSum {
  float visible;
  float open;
  vec3 bent;
};

SliceSum bitmask_slice(Surface surface, SliceLine line, Slice slice, vec3 direction, Search ahead,
                       Search behind) {
  SectorScale scale = make_sector_scale(slice);
  uint front = find_occluders(surface, ahead, make_side(surface, line, slice, scale, 1.0));
  uint back = find_occluders(surface, behind, make_side(surface, line, slice, scale, -1.0));
  uint thin = front | back;
  uint thick = filled_sectors(1.0, front) | filled_sectors(-1.0, back);
  SliceSum sum;
  sum.open = scale.open;
  sum.visible =
      mix(bitmask_visibility(scale, thin), bitmask_visibility(scale, thick), parameters.fill);
  sum.bent = vec3(0.0);
  if (kBentNormal) {
    vec2 bent =
        mix(bitmask_bent(slice, scale, thin), bitmask_bent(slice, scale, thick), parameters.fill);
    sum.bent = direction * bent.x + surface.view * bent.y;
  }
  return sum;
}

SliceSum horizon_slice(Surface surface, Slice slice, vec3 direction, Search ahead,
                       Search behind) {
  float front = find_horizon(ahead);
  float back = find_horizon(behind);
  SliceSum sum;
  sum.visible = slice_visibility(slice, front, back);
  sum.open = open_slice(slice);
  sum.bent = kBentNormal ? slice_bent_normal(slice, direction, surface.view, front, back)
                         : vec3(0.0);
  return sum;
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

void store_signal(ivec2 block, float visible, float open, float line) {
  Signal signal;
  signal.visible = visible;
  signal.open = open;
  imageStore(signal_image, block, uvec4(pack_signal(signal), floatBitsToUint(line), 0u, 0u));
}

void main() {
  ivec2 block = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(block * kDivisor, size_px()))) {
    return;
  }
  ivec2 pixel = min(block * kDivisor + ivec2(parameters.phase), size_px() - 1);
  float centre_line = fetch_line(pixel);
  if (centre_line == kSkyLine) {
    store_signal(block, 1.0, 1.0, kSkyLine);
    if (kBentNormal) {
      imageStore(bent_image, block, uvec4(0u));
    }
    return;
  }
  Surface surface = fetch_surface(pixel, centre_line);
  ViewBasis basis = make_view_basis(surface.view);
  SliceNoise noise = noise_at(uvec2(block));

  SliceSum sum = SliceSum(0.0, 0.0, vec3(0.0));
  for (uint i = 0; i < kSliceCount; ++i) {
    vec3 direction = slice_direction(basis, slice_angle(i, kSliceCount, noise.direction));
    Slice slice = make_slice(surface.normal, direction, surface.view);
    SliceLine line = make_slice_line(parameters.slope.xy, direction, surface.view);
    Search ahead = make_search(surface, line, slice, 1.0, noise.offset);
    Search behind = make_search(surface, line, slice, -1.0, noise.offset);
    SliceSum more = kBitmask ? bitmask_slice(surface, line, slice, direction, ahead, behind)
                             : horizon_slice(surface, slice, direction, ahead, behind);
    sum.visible += more.visible;
    sum.open += more.open;
    sum.bent += more.bent;
  }
  float mean = 1.0 / float(kSliceCount);
  store_signal(block, sum.visible * mean, sum.open * mean, centre_line);
  if (kBentNormal) {
    imageStore(bent_image, block, uvec4(pack_direction(sum.bent * mean), 0u, 0u));
  }
}
