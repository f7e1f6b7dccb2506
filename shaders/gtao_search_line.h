// Part of gtao.comp: the line of a slice on the image, and the depth samples along it.
//
// maths/slice_line.h explains the points (x w, y w, w) of a slice's plane. Here x and y are in
// units of the radius, so that a point lies within the radius if (x w)^2 + (y w)^2 <= w^2.
// Distances along the line, which are called offsets, are x w. Pixels (px) are texels of the image
// that is searched: with kHalfSearch each stands for 2x2 pixels of the depth buffer.
//
// Each sample is snapped to the centre of a texel, and then lies beside the line. If it lies on the
// tangent plane of the shaded point, its depth is moved to the line along that plane, so that a
// tilted plane does not occlude itself. Samples off the plane keep their depth.
#ifndef ALCOVE_GTAO_SEARCH_LINE_H
#define ALCOVE_GTAO_SEARCH_LINE_H

#include "gtao_bindings.h"
#include "gtao_surface.h"
#include "maths/connected_samples.h"
#include "maths/no_occluder.h"
#include "maths/sampling.h"
#include "maths/slice.h"
#include "maths/slice_line.h"

// A float of this size has no fraction bits, so that adding it rounds to the nearest integer, which
// then stands in the low bits. One addition replaces a rounding and a conversion, which costs as
// much as four additions on GCN.
const float kRoundingBias = 12582912.0;  // 1.5 * 2^23
const int kRoundingBits = 0x4B400000;

// The line along which a half-slice is searched. Offsets grow outwards from the shaded point.
struct SearchLine {
  vec2 px_per_offset;   // pixels on the image per unit of offset
  float offset_per_px;  // offset of one pixel along the line
  float radius;         // offset of the farthest point within the radius
  float tangent_rise;   // change of y w per unit of offset on the tangent plane
  vec2 y_per_px;        // change of y w per pixel between the shaded pixel and a texel
  float y_per_depth;    // change of y w per unit of inverse depth
  float level_rise;     // change of y w per unit of offset at constant depth
  float fading;         // argument of lies_on_tangent_plane() for offsets and y w
  float rounding;       // smallest y w that is not a rounding error, in the unit of `fading` * y w
  float y_at_zero;      // y w of a sample at the shaded pixel with inverse depth 0
};

float search_scale() { return mix(1.0, 2.0, kHalfSearch); }  // pixels of the depth buffer in a px
float nearest_px() { return mix(kNearestStep, 1.1, kHalfSearch); }  // least distance of a sample

SearchLine make_search_line(Surface surface, vec3 direction) {
  vec2 per_px = parameters.slope.xy * search_scale();
  SliceLine slice_line = make_slice_line(per_px, direction, surface.view);
  // The tangent plane is computed anew for each slice, because it would hold registers through all
  // slices.
  TangentPlane tangent =
      make_tangent_plane(per_px, surface.normal, surface.view, surface.depth, kPerspective);
  DepthStep depth_step = DepthStep(parameters.depth_step, parameters.depth_step_per_inverse_depth);
  float step = depth_step_at(depth_step, surface.inverse_depth);
  float per_radius = 1.0 / parameters.radius;
  float px_per_length = 1.0 / max(slice_line.x_per_step, 1e-30);
  float depth = kPerspective ? surface.depth : -1.0;
  float y_per_depth = slice_line.y_per_depth * depth;
  SearchLine search_line;
  search_line.px_per_offset = slice_line.direction_px * (parameters.radius * px_per_length);
  search_line.offset_per_px = slice_line.x_per_step * per_radius;
  search_line.radius =
      sphere_reach(slice_line, parameters.radius, surface.inverse_depth, kPerspective);
  search_line.tangent_rise =
      (dot(slice_line.direction_px, tangent.gradient) * y_per_depth + slice_line.y_per_step) *
      px_per_length;
  search_line.level_rise = slice_line.y_per_step * px_per_length;
  search_line.fading = tangent.fading * slice_line.x_per_step / abs(y_per_depth);
  search_line.y_per_depth = y_per_depth * per_radius;
  search_line.rounding = 2.0 * step * abs(search_line.y_per_depth) * search_line.fading;
  search_line.y_per_px = tangent.gradient * -search_line.y_per_depth;
  // The plane is raised towards the eye by one step of the depth buffer. A difference smaller than
  // that may be a rounding error, and must not occlude.
  float in_front = kPerspective ? step * depth + 1.0 : step - surface.inverse_depth;
  search_line.y_at_zero = -slice_line.y_per_depth * per_radius * in_front;
  // The image's border can move the traced pixel to one that search_image does not have.
  ivec2 moved = (ivec2(parameters.interleave_offset) & 1) - (surface.pixel & 1);
  if (kHalfSearch) search_line.y_at_zero += 0.5 * dot(vec2(moved), search_line.y_per_px);
  return search_line;
}

// Returns the line of the other half-slice, in which offsets grow in the opposite direction.
// Computing one line from the other takes fewer registers than keeping both.
SearchLine opposite(SearchLine search_line) {
  search_line.px_per_offset = -search_line.px_per_offset;
  search_line.tangent_rise = -search_line.tangent_rise;
  search_line.level_rise = -search_line.level_rise;
  return search_line;
}

// Returns false for surfaces so far away that the radius ends before the first sample in every
// direction. Slices need no search then.
bool reaches_samples(Surface surface) {
  vec2 per_px = abs(parameters.slope.xy * search_scale());
  // The least length of a pixel on the surface. The factor allows for the part of the sphere that
  // is nearer to the eye: 1 - radius / depth, for radii of up to a tenth of the depth.
  float length_per_px =
      0.9 * min(per_px.x, per_px.y) * surface.view.z * (kPerspective ? surface.depth : 1.0);
  return parameters.radius >= nearest_px() * length_per_px;
}

// One of the two directions of a slice, in which depth samples are taken outwards from the shaded
// point.
struct HalfSlice {
  SearchLine search_line;
  float side;            // +1 along the slice's direction, -1 against it
  uint steps;            // number of samples
  float growth;          // by this much, half the interval between samples grows per sample; zero
                         // if there is nothing to search
  float step_offset;     // of all samples, in steps, [0,1)
  vec2 border;           // offset of the image's border in this direction (x) and the other (y)
  ivec2 texel_bias;      // the shaded pixel in the image that is searched, minus kRoundingBits
  float inverse_depth;   // of the shaded point
  vec2 height;           // gradient of the height over the tangent plane in the slice's plane
  float tangent_cosine;  // cosine of the tangent plane's horizon
  float slice_cosine;    // cos(gamma), Slice::cosine
};

// Offsets from the surface's pixel to the border of the image that is searched: along the line (x)
// and against it (y). They end a hundredth of a pixel before it, which is ten times the spacing of
// floats at 16384 pixels.
vec2 border_offsets(Surface surface, SearchLine search_line) {
  vec2 centre = kHalfSearch ? vec2(surface.pixel >> 1) + 0.5 : centre_of(surface);
  vec2 size = vec2(kHalfSearch ? textureSize(search_image, 0) : size_px());
  vec2 direction = search_line.px_per_offset;
  vec2 inverse = 1.0 / mix(direction, vec2(1e-9), equal(direction, vec2(0.0)));
  vec2 low = -centre * inverse;
  vec2 high = (size - centre) * inverse;
  vec2 along = max(low, high);
  vec2 against = min(low, high);
  return vec2(min(along.x, along.y), -max(against.x, against.y)) - 0.01 * search_line.offset_per_px;
}

// Offset of the nearest possible sample.
float nearest_offset(HalfSlice half_slice) {
  return nearest_px() * half_slice.search_line.offset_per_px;
}

// Samples in one iteration of the loop over samples. An iteration costs as many instructions as
// half a sample, but each of its samples holds registers, and several slices hold more registers
// than one. sample/lab/gpu_cost/pass_work.cpp has the same numbers.
const uint kUnrolled = kSliceCount > 1u ? 2u : 4u;

// Up to this number, samples are not reduced to one per pixel.
const uint kFewSteps = 16u;
const bool kMayReduceSteps = !kHorizons && kStepCount > kFewSteps;

// The number of samples of a half-slice that searches `reach_px` pixels: at most one per pixel,
// because the steps between the texels of a tilted surface would otherwise look like
// discontinuities. The number differs from kStepCount by whole iterations of the loop over samples.
uint reduced_steps(float reach_px) {
  uint wanted = uint(clamp(reach_px + 1.0, float(kFewSteps), float(kStepCount)));
  return kStepCount - (kStepCount - wanted) / kUnrolled * kUnrolled;
}

// Offset of the last sample less that of the nearest.
float reach_of(HalfSlice half_slice) {
  float steps = float(half_slice.steps);
  return half_slice.growth * (steps * steps);
}

// Offset of the farthest point that can occlude. If the surface faces away from the half-slice,
// every point above its tangent plane and within the radius lies at most radius * cos(gamma) away
// on the image.
float search_distance(HalfSlice half_slice) {
  float radius = half_slice.search_line.radius;
  return half_slice.tangent_cosine > 0.0 ? radius * half_slice.slice_cosine : radius;
}

// How far surfaces are extrapolated beyond the image's border.
float extrapolated_distance(HalfSlice half_slice) {
  return clamp(search_distance(half_slice) - half_slice.border.x, 0.0,
               kExtrapolationRatio * reach_of(half_slice));
}

// The parts of the radius that lie beyond the image's border, [0,1], in this half-slice (x) and in
// the other one (y). A radius within the nearest step is searched nowhere, whether it lies outside
// or not.
vec2 outside_parts(HalfSlice half_slice) {
  float radius = half_slice.search_line.radius;
  vec2 outside = max(1.0 - half_slice.border / radius, 0.0);
  return radius >= nearest_offset(half_slice) ? outside : vec2(0.0);
}

// `border` is the offset of the image's border in the half-slice's direction (x) and in the other
// one (y).
HalfSlice make_half_slice(Surface surface, SearchLine search_line, Slice slice, float side,
                          vec2 border, float step_offset) {
  HalfSlice half_slice;
  half_slice.search_line = search_line;
  half_slice.side = side;
  half_slice.tangent_cosine = tangent_horizon(slice, side);
  half_slice.height = vec2(side * slice.along, slice.toward);
  float nearest = nearest_offset(half_slice);
  half_slice.slice_cosine = slice.cosine;
  float distance = search_distance(half_slice);
  bool empty = min(distance, border.x) < nearest;
  half_slice.steps = kStepCount;
  if (kMayReduceSteps) {
    half_slice.steps =
        reduced_steps((min(distance, border.x) - nearest) / search_line.offset_per_px);
  }
  float steps = float(half_slice.steps);
  // Samples stay apart if the radius spans few pixels, by a quarter of a pixel on average (chosen),
  // and inside the image in any case. The last number is no more than a length above 0.
  float apart = max(distance - nearest, 0.25 * steps * search_line.offset_per_px);
  float reach = max(min(apart, border.x - nearest), 1e-3 * search_line.offset_per_px);
  half_slice.growth = empty ? 0.0 : reach * (1.0 / (steps * steps));
  half_slice.border = border;
  half_slice.step_offset = step_offset;
  half_slice.texel_bias =
      (kHalfSearch ? surface.pixel >> 1 : in_inputs(surface.pixel)) - kRoundingBits;
  half_slice.inverse_depth = surface.inverse_depth;
  return half_slice;
}

// The half-slice with the samples of the second layer.
HalfSlice with_second_steps(HalfSlice half_slice) {
  float ratio = float(half_slice.steps) / float(kSecondStepCount);
  half_slice.growth *= ratio * ratio;
  half_slice.steps = kSecondStepCount;
  return half_slice;
}

// Whether there is nothing to search: the radius or the image ends before the first sample.
bool is_empty(HalfSlice half_slice) { return half_slice.growth == 0.0; }

// Offset of sample `k`. It grows with the square of `k`.
float sample_offset(HalfSlice half_slice, float k) {
  float steps = k + half_slice.step_offset;
  return steps * steps * half_slice.growth + nearest_offset(half_slice);
}

// Half the difference between the offsets of the samples 0 and 1. For each later pair of
// consecutive samples, HalfSlice::growth is added.
float first_half_interval(HalfSlice half_slice) {
  return (half_slice.step_offset + 0.5) * half_slice.growth;
}

// The inverse depth of a sample. It is 0 for the sky if the far plane is infinitely far away, so
// that the sky needs no test of its own; its points are then (x w, y w, 0) and never occlude.
float sample_inverse_depth(float depth_ndc) {
  float from_far = clamp(kReversed ? depth_ndc : 1.0 - depth_ndc, 0.0, 1.0);
  return kInfiniteFar ? parameters.inverse_depth_from_ndc.x * from_far
                      : inverse_depth_of(depth_ndc);
}

bool is_sky_sample(SliceSample here) {
  return kInfiniteFar ? here.inverse_depth <= 0.0
                      : here.inverse_depth == sky_inverse_depth(kPerspective);
}

// Subtracts kRoundingBias. `precise` keeps compilers from cancelling it against its addition. This
// is a function of its own because `precise` would otherwise extend to that addition, which could
// then not be fused with a multiplication.
float subtract_rounding_bias(float biased) {
  precise float rounded = biased - kRoundingBias;
  return rounded;
}

// The place at which a sample is taken.
struct SamplePlace {
  ivec2 texel;
  vec2 px;  // the pixels between the shaded pixel and the place
};

SamplePlace place_of(HalfSlice half_slice, float offset) {
  vec2 px = half_slice.search_line.px_per_offset * offset;
  vec2 biased = px + kRoundingBias;
  vec2 rounded = vec2(subtract_rounding_bias(biased.x), subtract_rounding_bias(biased.y));
  return SamplePlace(floatBitsToInt(biased) + half_slice.texel_bias, rounded);
}

// The distance along the line between the places of samples at two offsets.
float place_distance(HalfSlice half_slice, float from, float to) {
  vec2 px = place_of(half_slice, to).px - place_of(half_slice, from).px;
  float per_px = half_slice.search_line.offset_per_px;
  return dot(px, half_slice.search_line.px_per_offset) * (per_px * per_px);
}

// The sample at an offset, in a layer of depth: 0 is the depth buffer, 1 the layer that it hides.
SliceSample fetch_sample(HalfSlice half_slice, uint layer, float offset) {
  SearchLine search_line = half_slice.search_line;
  SamplePlace place = place_of(half_slice, offset);
  vec2 px = place.px;
  SliceSample found;
  float depth_ndc = layer == 1u   ? texelFetch(second_image, place.texel, 0).r
                    : kHalfSearch ? texelFetch(search_image, place.texel, 0).r
                                  : texelFetch(depth_image, place.texel, 0).r;
  found.inverse_depth = sample_inverse_depth(depth_ndc);
  float y = found.inverse_depth * search_line.y_per_depth + search_line.y_at_zero;
  float y_of_texel = offset * search_line.level_rise + y;
  y = px.y * search_line.y_per_px.y + y;
  y = px.x * search_line.y_per_px.x + y;
  bool on_plane = lies_on_tangent_plane(search_line.fading, y, offset + search_line.rounding);
  // Below the tangent plane nothing occludes, so that rounding errors there need not look like
  // discontinuities.
  y = on_plane ? offset * search_line.tangent_rise + max(y, 0.0) : y_of_texel;
  found.point = vec3(offset, y, kPerspective ? found.inverse_depth : 1.0);
  if (kBackFaces) {
    float back = inverse_depth_of(texelFetch(back_image, place.texel, 0).r);
    // The back face may not lie in front of the front face.
    float end = farther_inverse_depth(found.inverse_depth, back, kPerspective);
    found.back = ends_occluder(found.inverse_depth, back, kPerspective)
                     ? vec2(offset, y + (end - found.inverse_depth) * search_line.y_per_depth)
                     : vec2(0.0, kNoBack);
  }
  if (kMask && layer == 0u && is_no_occluder(depth_ndc)) {
    // Far in front of the surface and outside of every radius: such a foreground does not occlude,
    // and what lies behind it is unobserved.
    found.point = vec3(offset, 1e6, 0.0);
    found.back = vec2(0.0, kNoBack);
  }
  return found;
}

float squared_length(vec2 v) { return dot(v, v); }

// Whether a sample lies within the radius around the shaded point.
bool within_radius(SliceSample here) {
  return squared_length(here.point.xy) <= here.point.z * here.point.z;
}

#endif
