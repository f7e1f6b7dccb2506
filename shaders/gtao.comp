#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

// Ground-truth ambient occlusion [Jimenez 2016]. Each traced pixel searches the depth buffer in a
// few slices, and integrates the visible part of each slice in closed form.
//
// This file has the default estimator, connected samples, from top to bottom: the surface of the
// traced pixel, the depth samples of a half-slice, the occluders that they show, the visible part
// of the half-slice, and the sums over slices. Three other estimators take the place of
// add_connected(): the paper's horizons (gtao_horizons.h), its thickness heuristic
// (gtao_heuristic.h) and the visibility bitmask (gtao_bitmask.h).
//
// Each traced pixel writes two sums over its slices: the visible part, and the same integral
// without occluders. Filters and history sum both and divide at the end, because the mean of ratios
// would be biased. The bent-normal residual is also a sum over slices, in view space. With
// SPECULAR, the two sums of the surface's GGX lobe are also written.

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
layout(constant_id = 1) const uint kStepCount = 12;  // depth samples of a half-slice
layout(constant_id = 2) const bool kBentNormal = false;
layout(constant_id = 3) const uint kEstimator = 0;  // a value of the C++ enum Estimator
layout(constant_id = 4) const int kTileSize = 1;    // one pixel is traced in a tile of this width
layout(constant_id = 5) const uint kPattern = 0;    // a value of the C++ enum Pattern
layout(constant_id = 6) const bool kPerspective = true;
layout(constant_id = 7) const bool kRoughnessTexture = false;
layout(constant_id = 8) const int kRoughnessChannel = 0;
layout(constant_id = 9) const bool kUniformWeight = false;  // no cosine of the normal
layout(constant_id = 10) const bool kFalloff = false;       // occluders fade towards the radius
layout(constant_id = 11) const bool kThicknessOfDistance = false;  // else a part of the radius
layout(constant_id = 12) const bool kBackFaces = false;            // back_image tells the thickness
layout(constant_id = 13) const bool kSnapToTexels = true;   // samples lie at centres of texels
layout(constant_id = 14) const bool kSecondLayer = false;   // second_image occludes too
layout(constant_id = 15) const bool kExtrapolation = true;  // surfaces continue beyond the image
layout(constant_id = 16) const bool kUnobserved = true;     // excludes unobserved directions
layout(constant_id = 17) const uint kNormalEncoding = 0;    // a value of the enum NormalEncoding
layout(constant_id = 18) const bool kReversed = false;      // raw depth is 1 at the near plane

const uint kHeuristic = 1;
const uint kBitmask = 2;
const uint kConnected = 3;
const bool kLeaveOutUnobserved = kEstimator == kConnected && kUnobserved;

layout(set = 0, binding = 0) uniform Parameters { GtaoParameters parameters; };
layout(set = 0, binding = 1) uniform texture2D depth_image;   // as the projection wrote it
layout(set = 0, binding = 2) uniform texture2D normal_image;  // view_from_normal rotates it
// Packed RawOcclusion and inverse depth; with SPECULAR also those of the GGX lobe and its surface.
layout(set = 0, binding = 3) uniform writeonly uimage2D raw_image;
// Without kBentNormal it is never written, and the raw occlusion is bound in its place.
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

// The surface that a traced pixel shows.
struct Surface {
  ivec2 pixel;
  float depth;       // linear, scene units
  float depth_step;  // between the inverse depths that the depth buffer can hold there
  vec3 normal;       // unit, view space
  vec3 view;         // unit, view space, towards the eye
  TangentPlane tangent;
  LobeSurface lobe;  // with the normal as the texture has it
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

// The centre of the surface's pixel, in pixels from the image's corner.
vec2 centre_of(Surface surface) { return vec2(surface.pixel) + 0.5; }

// The surface at a pixel that is not the sky, whose inverse depth is already loaded.
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
  surface.lobe = LobeSurface(kLobe ? normalize(own) : own, fetch_roughness(pixel));
  surface.tangent = make_tangent_plane(parameters.slope.xy, surface.normal, surface.view,
                                       surface.depth, kPerspective);
  surface.tangent.inverse_depth = inverse_depth;
  return surface;
}

// Sums over the two half-slices of a slice.
struct SliceSum {
  float visible;        // visible part, weighted by the cosine of the normal
  float left_out;       // the part of `visible` and of the open slice that is unobserved
  vec2 bent;            // sum of visible directions: along the slice's direction, along the view's
  RawOcclusion lobe;    // visible part of the GGX lobe
  float lobe_left_out;  // the part of the lobe that is unobserved
};

RawOcclusion no_lobe() { return RawOcclusion(0.0, 0.0); }

// One of the two directions of a slice, in which depth samples are taken outwards from the shaded
// point. Lengths in the slice's plane are in units of the width of a pixel at the surface's depth.
struct HalfSlice {
  float side;             // +1 along the slice's direction, -1 against it
  float open_arc;         // the half-slice's part of the integral without occluders
  vec2 direction_px;      // on the image, outwards, unit; zero if there is nothing to search
  float unit;             // factor from scene units to the unit of this struct
  float radius;           // in the unit of this struct
  float slope;            // change of the tangent plane's inverse depth per pixel outwards
  float tangent_rise;     // y (times w) of the tangent plane per pixel outwards
  float rise_off_plane;   // y (times w) per unit of inverse depth off the tangent plane
  float tangent_cosine;   // cosine of the tangent plane's horizon
  float reach_px;         // from the first sample to the last; 0 if there is nothing to search
  float reach_per_step;   // reach_px over the squared number of steps
  float step_offset;      // of all samples, in steps, [0,1)
  float radius_px;        // the radius on the image
  float extrapolated_px;  // how far surfaces are extrapolated beyond the image's border
  float outside;          // the part of the radius that lies beyond the image's border, [0,1]
  float other_outside;    // `outside` of the other half-slice
  ivec2 texel_bias;       // the shaded pixel minus the bits of kRoundingBias
  vec2 height;            // gradient of the height over the tangent plane in the slice's plane
  // Smallest change of slope, in inverse depth per pixel, between two surfaces.
  float smallest_discontinuity;
  float depth_step;  // Surface::depth_step
  float nearness;    // the radius divided by the distance in perspective, else 0
  TangentPlane tangent;
};

// A float of this size has no fraction bits, so that adding it rounds to the nearest integer, which
// then stands in the low bits. One addition replaces a rounding and a conversion, which costs as
// much as four additions on GCN.
const float kRoundingBias = 12582912.0;  // 1.5 * 2^23
const int kRoundingBits = 0x4B400000;

// Smallest change of slope (depth difference divided by lateral distance) that counts as a
// discontinuity between two surfaces.
const float kDepthDiscontinuity = 4.0;

// Distances in pixels from `centre` to the border of the image, along `direction` and against it.
vec2 border_distances(vec2 centre, vec2 direction) {
  vec2 inverse = 1.0 / mix(direction, vec2(1e-9), equal(direction, vec2(0.0)));
  vec2 low = -centre * inverse;
  vec2 high = (vec2(size_px()) - centre) * inverse;
  vec2 along = max(low, high);
  vec2 against = min(low, high);
  return vec2(min(along.x, along.y), -max(against.x, against.y)) - 0.01;
}

// The part of the radius that lies beyond the image's border, [0,1].
float outside_share(float border_px, float radius_px) {
  return radius_px < kNearestStep ? 0.0 : max(1.0 - border_px / radius_px, 0.0);
}

// `radius_px` is the radius on the image, `border_px` the distance to the image's border in the
// half-slice's direction (x) and in the other one (y).
HalfSlice make_half_slice(Surface surface, SliceLine slice_line, Slice slice, float side,
                          float open_arc, float radius_px, vec2 border_px, float step_offset) {
  HalfSlice half_slice;
  half_slice.side = side;
  half_slice.open_arc = open_arc;
  half_slice.unit = 1.0 / max(slice_line.x_per_step, 1e-30);
  half_slice.radius = parameters.radius * half_slice.unit;
  vec2 direction_px = slice_line.direction_px * side;
  half_slice.tangent_cosine = tangent_horizon(slice, side);
  half_slice.radius_px = radius_px;
  // If the surface faces away from the half-slice, every point above its tangent plane and within
  // the radius lies at most radius * cos(gamma) away on the image.
  float distance_px = half_slice.tangent_cosine > 0.0 ? radius_px * slice.cosine : radius_px;
  bool empty = min(distance_px, border_px.x) < kNearestStep;
  // Samples stay apart if the radius spans few pixels, and inside the image in any case.
  float apart_px = max(distance_px - kNearestStep, 0.25 * float(kStepCount));
  half_slice.reach_px = empty ? 0.0 : max(min(apart_px, border_px.x - kNearestStep), 1e-3);
  half_slice.reach_per_step = half_slice.reach_px * (1.0 / (float(kStepCount) * float(kStepCount)));
  half_slice.extrapolated_px =
      clamp(distance_px - border_px.x, 0.0, kExtrapolationRatio * half_slice.reach_px);
  half_slice.outside = outside_share(border_px.x, radius_px);
  half_slice.other_outside = outside_share(border_px.y, radius_px);
  // All samples of an empty half-slice are the shaded pixel: the first step may lie outside the
  // image.
  half_slice.direction_px = empty ? vec2(0.0) : direction_px;
  half_slice.step_offset = step_offset;
  half_slice.texel_bias = surface.pixel - kRoundingBits;
  half_slice.depth_step = surface.depth_step;
  half_slice.nearness = kPerspective ? parameters.radius * surface.tangent.inverse_depth : 0.0;
  half_slice.tangent = surface.tangent;
  half_slice.height = vec2(side * slice.along, slice.toward);
  half_slice.smallest_discontinuity = kDepthDiscontinuity * slice_line.x_per_step *
                                      (kPerspective ? surface.tangent.inverse_depth : 1.0);
  half_slice.slope = dot(direction_px, surface.tangent.gradient);
  half_slice.rise_off_plane =
      slice_line.y_per_depth * half_slice.unit * (kPerspective ? surface.depth : -1.0);
  half_slice.tangent_rise =
      side * slice_line.y_per_step * half_slice.unit + half_slice.slope * half_slice.rise_off_plane;
  return half_slice;
}

// Distance of sample `k` from the shaded pixel. It grows with the square of `k`.
float sample_offset_px(HalfSlice half_slice, float k) {
  float steps = k + half_slice.step_offset;
  return steps * steps * half_slice.reach_per_step + kNearestStep;
}

// The point of the slice's plane `along_px` pixels outwards, `off_plane` off the tangent plane in
// inverse depth, as slice_point() of maths/slice_line.h gives it.
vec2 plane_point(HalfSlice half_slice, float along_px, float off_plane) {
  return vec2(along_px, along_px * half_slice.tangent_rise + off_plane * half_slice.rise_off_plane);
}

// Sample `k` of a layer of depth: 0 is the depth buffer, 1 the layer that it hides.
SliceSample fetch_sample(HalfSlice half_slice, uint layer, uint k) {
  SliceSample found;
  found.offset_px = sample_offset_px(half_slice, float(k));
  precise vec2 biased = half_slice.direction_px * found.offset_px + kRoundingBias;
  precise vec2 snapped = biased - kRoundingBias;
  ivec2 texel = floatBitsToInt(biased) + half_slice.texel_bias;
  found.inverse_depth = layer == 0u ? load_inverse_depth(texel)
                                    : inverse_depth_of(texelFetch(second_image, texel, 0).r);
  float along_px = kSnapToTexels ? dot(snapped, half_slice.direction_px) : found.offset_px;
  // Changes of the tangent plane's inverse depth from the shaded pixel to the texel and to the
  // line.
  float to_texel = dot(snapped, half_slice.tangent.gradient);
  float to_line = along_px * half_slice.slope;
  float off_plane = (found.inverse_depth - half_slice.tangent.inverse_depth) - to_texel;
  // A difference smaller than the step of the depth buffer may be a rounding error.
  off_plane -= clamp(off_plane, -half_slice.depth_step, half_slice.depth_step);
  bool on_plane = lies_on_tangent_plane(half_slice.tangent, off_plane, found.offset_px);
  found.off_plane = off_plane + (kSnapToTexels && on_plane ? 0.0 : to_texel - to_line);
  found.point = vec3(plane_point(half_slice, along_px, found.off_plane),
                     kPerspective ? found.inverse_depth : 1.0);
  if (kBackFaces) {
    float back = inverse_depth_of(texelFetch(back_image, texel, 0).r);
    // The back face may not lie in front of the front face, which may have been moved.
    float front = half_slice.tangent.inverse_depth + to_line + found.off_plane;
    float end = farther_inverse_depth(front, back, kPerspective);
    found.back = ends_occluder(found.inverse_depth, back, kPerspective)
                     ? plane_point(half_slice, along_px, found.off_plane + (end - front))
                     : vec2(0.0, kNoBack);
  }
  return found;
}

// The thickness that the settings give an occluder at a sample, times w as slice_point() has it.
float settings_thickness(HalfSlice half_slice, SliceSample here) {
  // In perspective w times the distance is 1; an orthographic depth may lie behind the eye.
  float distance = kPerspective ? 1.0 : abs(here.inverse_depth);
  return parameters.thickness * half_slice.unit * (kThicknessOfDistance ? distance : here.point.z);
}

float squared_length(vec2 v) { return dot(v, v); }

// Whether a sample lies within the radius around the shaded point.
bool within_radius(HalfSlice half_slice, SliceSample here) {
  float radius = half_slice.radius * here.point.z;
  return squared_length(here.point.xy) <= radius * radius;
}

// The default estimator, connected samples. It finds which sectors of a half-slice are occluded by
// surfaces of finite thickness (maths/connected_samples.h) and which directions the depth buffer
// does not show (maths/unobserved.h).
//
// Sectors are a bit mask from the view direction (bit 0) to the tangent plane. An interval of
// sectors is the exclusive or of the two masks "all sectors beyond a position", in any order.

// The state of the search after a sample.
struct SegmentState {
  float rise;         // change of SliceSample::off_plane over the last sample interval
  float interval_px;  // width of the last sample interval
  DepthDiscontinuity discontinuity;  // at the last sample
  float x;                           // x (times w) of the last sample
  uint beyond;                       // sectors beyond the last sample
  bool inside;                       // whether the last sample lies within the radius
  uint occluded;                     // sectors that are occluded so far
  uint runs;                         // one bit per sample: whether it is part of an occluder run
  float run_px;                      // width of all occluder runs together
  uint unobserved;  // one bit per sample: whether it hides points within the radius behind it
  bool known_back;  // whether a back face told where an occluder ends
};

// The occluders that were found in a half-slice.
struct Occluders {
  uint occluded;           // sectors
  float hidden_occlusion;  // fraction of the sectors hidden behind the first that is occluded
  bool known_back;         // whether back faces told where occluders end
  Unobserved unobserved;
  // Offset of the last sample; kNowherePx if the surface beyond the border is known.
  float border_px;
};

// The bit of sample `k` in a mask of samples. With more than 32 samples, several share a bit.
uint sample_bit(uint k) { return 1u << (kStepCount <= 32u ? k : k * 32u / kStepCount); }

// The number of the first sample in a mask of samples.
float first_sample(uint bits) {
  float bit = float(findLSB(bits));
  return kStepCount <= 32u ? bit : bit * (float(kStepCount) / 32.0);
}

// The number of runs of adjacent samples in a mask of samples.
float run_count(uint bits) { return float(bitCount(bits & ~(bits << 1u))); }

// Whether the samples of a layer tell which directions are unobserved. Only the last layer's do.
bool tells_unobserved(uint layer) {
  return kLeaveOutUnobserved && layer == (kSecondLayer ? 1u : 0u);
}

// Adds a sample. `joined` tells whether it continues the surface of the last sample. If it does
// not, its surface begins `edge_px` pixels before it.
void add_sample(inout SegmentState state, HalfSlice half_slice, float sectors, uint layer, uint bit,
                SliceSample here, bool joined, float edge_px) {
  bool inside = within_radius(half_slice, here);
  // A surface that begins between two samples begins at its edge.
  float x = joined ? here.point.x : here.point.x - edge_px;
  float scale = 1.0 / (x + abs(here.point.y));
  float height = here.point.y * scale;
  uint front = biased_position(sectors, height);
  uint beyond = sectors_beyond(front);
  // At its leading edge an occluder is at most as thick as its visible width.
  float thickness = settings_thickness(half_slice, here);
  thickness = joined ? thickness : min(thickness, edge_px);
  uint back = biased_position(sectors, height_of_back(height, scale, thickness));
  if (kBackFaces && here.back.y < kNoBack) {
    back = biased_position(sectors, 1.0 - diamond_angle(here.back));
    state.known_back = true;
  }
  state.occluded |= inside ? beyond ^ sectors_beyond(back) : 0u;
  state.occluded |= joined && state.inside ? beyond ^ state.beyond : 0u;
  bool nearer = here.point.y > 0.0;
  // A sample is part of an occluder run if it stands above the tangent plane by more than a sector,
  // and lies within the radius or nearer to the eye than the shaded point.
  bool hides = front < kPositionBits + kEvenSectorCount && (inside || nearer);
  state.runs |= hides ? bit : 0u;
  state.run_px += hides ? state.interval_px : 0.0;
  if (tells_unobserved(layer)) {
    state.unobserved |= !inside && nearer ? bit : 0u;
  }
  state.beyond = beyond;
  state.inside = inside;
  state.x = here.point.x;
}

// Adds the sample `here` (any but the first). Whether it is connected to the previous sample
// depends on the change of slope of the inverse depth at `here`, for which the following sample
// `next` is needed. Then sets `here` to `next`.
void pass_sample(inout SegmentState state, inout SliceSample here, HalfSlice half_slice,
                 float sectors, uint layer, uint bit, SliceSample next) {
  float rise = next.off_plane - here.off_plane;
  float interval_px = next.offset_px - here.offset_px;
  DepthDiscontinuity discontinuity = depth_discontinuity(
      state.rise, state.interval_px, rise, interval_px, half_slice.smallest_discontinuity);
  bool joined = layer == 0u ? samples_join(state.discontinuity, discontinuity)
                            : hidden_samples_join(state.discontinuity, discontinuity);
  add_sample(state, half_slice, sectors, layer, bit, here, joined, kEdgeShare * state.interval_px);
  state.rise = rise;
  state.interval_px = interval_px;
  state.discontinuity = discontinuity;
  here = next;
}

// The sectors that a surface occludes beyond the image's border. A surface that leaves the image
// without a discontinuity continues as the plane through its last two samples.
uint extrapolated_sectors(SegmentState state, float last_step_px, HalfSlice half_slice,
                          float sectors, SliceSample last) {
  float slope = state.rise / max(last_step_px, 1e-3);
  float way_px = extrapolated_way(last.inverse_depth, half_slice.slope + slope,
                                  half_slice.extrapolated_px, kPerspective);
  vec2 end = plane_point(half_slice, last.point.x + way_px, last.off_plane + slope * way_px);
  bool goes_on =
      way_px > 0.0 && last_step_px > 0.1 && !is_discontinuous(state.discontinuity) && state.inside;
  return goes_on ? state.beyond ^ sectors_beyond(biased_position(sectors, 1.0 - diamond_angle(end)))
                 : 0u;
}

// Samples in one iteration of the loop over samples. An iteration costs as many instructions as
// half a sample, but each of its samples holds registers, and several slices hold more registers
// than one. passes/cost/gtao.cpp has the same numbers.
const uint kUnrolled = kSliceCount > 1u ? 2u : 4u;

// The occluders that the samples of one depth layer show.
Occluders find_in_layer(HalfSlice half_slice, float sectors, uint layer) {
  SliceSample first = fetch_sample(half_slice, layer, 0u);
  SliceSample here = fetch_sample(half_slice, layer, 1u);
  SegmentState state;
  state.occluded = 0u;
  state.runs = 0u;
  state.run_px = 0.0;
  state.unobserved = 0u;
  state.known_back = false;
  state.beyond = 0u;
  state.inside = false;
  // The first sample continues the surface itself if it lies on its tangent plane.
  bool joined = !stands_above_tangent(first.point.xy, half_slice.height);
  state.interval_px = first.offset_px;
  add_sample(state, half_slice, sectors, layer, 1u, first, joined, kEdgeShare * first.offset_px);
  state.rise = here.off_plane - first.off_plane;
  state.interval_px = here.offset_px - first.offset_px;
  state.discontinuity = depth_discontinuity(first.off_plane, first.offset_px, state.rise,
                                            state.interval_px, half_slice.smallest_discontinuity);
  const uint rest = (kStepCount - 2u) % kUnrolled;
  uint k = 2u;
  [[unroll]] for (uint i = 0u; i < rest; ++i) {
    pass_sample(state, here, half_slice, sectors, layer, sample_bit(k + i - 1u),
                fetch_sample(half_slice, layer, k + i));
  }
  k += rest;
  if (k < kStepCount) {
    do {
      [[unroll]] for (uint i = 0u; i < kUnrolled; ++i) {
        pass_sample(state, here, half_slice, sectors, layer, sample_bit(k + i - 1u),
                    fetch_sample(half_slice, layer, k + i));
      }
      k += kUnrolled;
    } while (k < kStepCount);
  }
  // No sample follows the last one, so it is joined only if there is no discontinuity before it.
  float last_step_px = here.point.x - state.x;
  add_sample(state, half_slice, sectors, layer, sample_bit(kStepCount - 1u), here,
             !is_discontinuous(state.discontinuity), kEdgeShare * state.interval_px);
  uint extrapolated =
      kExtrapolation ? extrapolated_sectors(state, last_step_px, half_slice, sectors, here) : 0u;
  float searched_px = kNearestStep + half_slice.reach_px;
  Occluders found;
  found.occluded = state.occluded | extrapolated;
  float before_first_px = (state.runs & 1u) != 0u || state.runs == 0u
                              ? 0.0
                              : sample_offset_px(half_slice, first_sample(state.runs) - 1.0);
  float run_share =
      state.run_px / (max(run_count(state.runs), 1.0) * max(searched_px - before_first_px, 1e-3));
  found.hidden_occlusion = hidden_occlusion_behind(run_share, parameters.hidden_exponent);
  found.known_back = state.known_back;
  found.unobserved = nothing_unobserved();
  if (tells_unobserved(layer)) {
    float first_k = first_sample(state.unobserved);
    float count = float(bitCount(state.unobserved)) * max(float(kStepCount) / 32.0, 1.0);
    found.unobserved.first_px =
        state.unobserved == 0u ? kNowherePx : sample_offset_px(half_slice, first_k);
    // The width of the unobserved samples if all of them were adjacent to the first one.
    found.unobserved.width_px = max(half_slice.reach_per_step * count *
                                        (2.0 * (first_k + half_slice.step_offset) + count - 2.0),
                                    0.0);
    found.unobserved.rows = run_count(state.unobserved);
  }
  bool known = extrapolated != 0u || here.inverse_depth == sky_inverse_depth(kPerspective);
  found.border_px = known ? kNowherePx : here.offset_px;
  if (half_slice.reach_px <= 0.0) {
    found = Occluders(0u, 0.0, false, nothing_unobserved(), found.border_px);
  }
  return found;
}

// The occluders that all depth layers show.
Occluders find_occluders(HalfSlice half_slice, float sectors) {
  Occluders found = find_in_layer(half_slice, sectors, 0u);
  if (kSecondLayer) {
    Occluders behind = find_in_layer(half_slice, sectors, 1u);
    found.occluded |= behind.occluded;
    found.unobserved = behind.unobserved;
  }
  return found;
}

// The arc of unobserved directions before the first occluder, which begins at `first_light`.
UnobservedArc find_unobserved(HalfSlice half_slice, vec2 first_light, Occluders found) {
  Unobserved unobserved = add_beyond_border(
      mean_row(found.unobserved), found.border_px, half_slice.outside * half_slice.radius_px,
      border_share(half_slice.other_outside, half_slice.nearness));
  return make_unobserved_arc(first_light, unobserved, half_slice.radius_px);
}

// Adds the visible part of a half-slice. A share of its unobserved directions is left out.
void add_connected(inout SliceSum sum, HalfSlice half_slice, Slice slice, LobeSlice lobe) {
  vec2 tangent = tangent_light(slice, half_slice.side);
  float tangent_angle = tangent_diamond_angle(slice, half_slice.side);
  Occluders found = find_occluders(half_slice, 1.0 / tangent_angle);
  bool open = found.occluded == 0u;
  float sector = tangent_angle * (1.0 / float(kEvenSectorCount));
  vec2 first_light = open ? tangent : diamond_angle_light(float(findLSB(found.occluded)) * sector);
  float arc =
      open ? half_slice.open_arc : part_arc(slice, half_slice.side, first_light, kUniformWeight);
  if (kBackFaces && found.known_back) {
    // Back faces show which directions behind an occluder are visible. They are integrated exactly.
    VisiblePart part =
        visible_part(slice, half_slice.side, 1.0 / sector, repeat_last_sector(found.occluded),
                     found.hidden_occlusion, PartRequest(kUniformWeight, kBentNormal));
    sum.visible += part.arc;
    sum.bent += part.bent;
  } else {
    // The arc up to the first occluder is visible. The visible sectors beyond it count as a share
    // of the rest of the open arc, reduced by the hidden occlusion.
    float beyond = (1.0 - found.hidden_occlusion) * visible_share_beyond(found.occluded);
    sum.visible += arc + beyond * (half_slice.open_arc - arc);
    if (kBentNormal) {
      vec2 bent = bent_light_arc(slice, half_slice.side, first_light);
      sum.bent += bent + beyond * (bent_light_arc(slice, half_slice.side, tangent) - bent);
    }
  }
  if (kLobe) {
    sum.lobe.visible += visible_lobe(lobe, half_slice.side, 1.0 / sector,
                                     repeat_last_sector(found.occluded), found.hidden_occlusion);
  }
  if (kLeaveOutUnobserved) {
    UnobservedArc unobserved = find_unobserved(half_slice, first_light, found);
    sum.left_out += unobserved.share *
                    (arc - part_arc(slice, half_slice.side, unobserved.from, kUniformWeight));
    if (kLobe) sum.lobe_left_out += unobserved_lobe(unobserved, lobe, half_slice.side);
  }
}

#include "gtao_bitmask.h"
#include "gtao_heuristic.h"
#include "gtao_horizons.h"

// Adds the visible part of a half-slice to the sums of its slice.
void add_half_slice(inout SliceSum sum, HalfSlice half_slice, Slice slice, LobeSlice lobe) {
  switch (kEstimator) {
    case kConnected:
      add_connected(sum, half_slice, slice, lobe);
      break;
    case kBitmask:
      add_bitmask(sum, half_slice, slice, lobe);
      break;
    case kHeuristic:
      add_heuristic(sum, half_slice, slice, lobe);
      break;
    default:
      add_horizons(sum, half_slice, slice, lobe);
  }
}

// The contribution of a slice to the pixel's sums.
struct SliceResult {
  RawOcclusion raw_occlusion;
  vec3 residual;
  vec3 expected_residual;
  RawOcclusion lobe;
};

// Subtracts a part from the visible and from the open sum.
RawOcclusion leave_out(RawOcclusion sum, float part) {
  return RawOcclusion(max(sum.visible - part, 0.0), sum.open - part);
}

// Searches both half-slices of a slice, and integrates their visible parts.
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
    HalfSlice half_slice =
        make_half_slice(surface, slice_line, slice, side, i == 0u ? open_arcs.x : open_arcs.y,
                        radius_px, i == 0u ? border_px.xy : border_px.yx, step_offset);
    add_half_slice(sum, half_slice, slice, lobe);
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

// Direction and offset of a tile's samples in this frame.
SliceNoise noise_at(uvec2 tile) {
  switch (kPattern) {
    case 1:
      return hilbert_pattern(tile, parameters.frame);
    case 2:
      return paper_pattern(tile, parameters.frame);
    default:
      return golden_pattern(tile, parameters.frame, kTileSize > 1);
  }
}

// Packs the sums of a lobe, scaled so that sums of narrow and of wide lobes have about the same
// size. Neighbours of different roughness can then be averaged.
uvec2 pack_scaled_lobe(LobeSurface surface, RawOcclusion lobe) {
  float scale = max(surface.roughness * surface.roughness, kSmallestLobe);
  lobe = RawOcclusion(lobe.visible * scale, lobe.open * scale);
  return uvec2(pack_lobe(lobe), pack_lobe_surface(surface));
}

// `to_open` is 0 for the sums as they are and 1 for those of an unoccluded surface.
RawOcclusion faded(RawOcclusion sum, float to_open) {
  return RawOcclusion(mix(sum.visible, sum.open, to_open), sum.open);
}

// Fades the sums to unoccluded ones if the depth buffer cannot resolve the radius.
SliceResult fade_unresolved(SliceResult sum, float to_open) {
  sum.raw_occlusion = faded(sum.raw_occlusion, to_open);
  sum.residual = kBentNormal ? mix(sum.residual, sum.expected_residual, to_open) : vec3(0.0);
  if (kLobe) {
    sum.lobe = faded(sum.lobe, to_open);
  }
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

// Searches slice `i` and adds it to the pixel's sums.
void add_slice(inout SliceResult sum, Surface surface, SliceNoise noise, uint i) {
  // The basis is computed anew for each slice, because it would hold six registers through all
  // slices.
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

// Searches all slices of a pixel that is not the sky.
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
  ivec2 tile = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(tile * kTileSize, size_px()))) {
    return;
  }
  ivec2 pixel = min(tile * kTileSize + ivec2(parameters.interleave_offset), size_px() - 1);
  float inverse_depth = load_inverse_depth(pixel);
  SearchResult result = sky_result();
  if (inverse_depth != sky_inverse_depth(kPerspective)) {
    result = search_pixel(pixel, inverse_depth, noise_at(uvec2(tile)));
  }
  imageStore(raw_image, tile, result.raw_occlusion);
  if (kBentNormal) {
    imageStore(bent_image, tile, uvec4(result.bent, 0u, 0u));
  }
}
