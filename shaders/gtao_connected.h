// Part of gtao.comp: the default estimator, connected samples. It finds which sectors of a
// half-slice are occluded by surfaces of finite thickness (maths/connected_samples.h) and which
// directions the depth buffer does not show (maths/unobserved.h).
//
// Sectors are a bit mask from the view direction (bit 0) to the tangent plane. An interval of
// sectors is the exclusive or of the two masks "all sectors beyond a position", in any order.
#ifndef ALCOVE_GTAO_CONNECTED_H
#define ALCOVE_GTAO_CONNECTED_H

#include "gtao_search_line.h"
#include "gtao_slice_sum.h"
#include "maths/connected_samples.h"
#include "maths/gtao.h"
#include "maths/lobe_slice.h"
#include "maths/unobserved.h"
#include "maths/visibility_bitmask.h"

// The state of the search after a sample.
struct SegmentState {
  float rise;                        // change of y (times w) over the last sample interval
  float half_interval;               // half the width of the last sample interval
  DepthDiscontinuity discontinuity;  // at the last sample
  uint beyond;                       // sectors beyond the last sample
  bool inside;                       // whether the last sample lies within the radius
  uint occluded;                     // sectors that are occluded so far
  float begin;                       // offset at which the surface of the last sample begins
  uvec2 runs;                        // the samples that are part of an occluder run
  float half_width;                  // half the width of all occluder runs together
  uvec2 unobserved;                  // the samples that hide points within the radius behind them
  bool known_back;                   // whether a back face told where an occluder ends
};

// The occluders that were found in a half-slice.
struct Occluders {
  uint occluded;           // sectors
  float hidden_occlusion;  // fraction of the sectors hidden behind the first that is occluded
  bool known_back;         // whether back faces told where occluders end
  Unobserved unobserved;
  float border;  // offset of the last sample; kNowhere if the surface beyond the border is known
};

// Smallest change of slope (y over x in the slice's plane) that counts as a discontinuity between
// two surfaces.
const float kDepthDiscontinuity = 4.0;

// Converts an integer below 2^23 to a float. On GCN a conversion costs as much as four additions.
float small_float(uint value) { return uintBitsToFloat(0x4B000000u + value) - 8388608.0; }

// Sets of samples are bit masks. The second word is 0 with at most 32 samples.
void add_to_set(inout uvec2 samples, uint k, bool contained) {
  uint bit = contained ? 1u << (k & 31u) : 0u;
  if (kStepCount > 32u && k >= 32u)
    samples.y |= bit;
  else
    samples.x |= bit;
}

// The number of samples in a set.
float count_of(uvec2 samples) { return small_float(bit_count(samples.x) + bit_count(samples.y)); }

// The number of the first sample in a set, which must not be empty.
float first_sample(uvec2 samples) {
  return kStepCount <= 32u || samples.x != 0u ? small_float(lowest_bit(samples.x))
                                              : small_float(lowest_bit(samples.y)) + 32.0;
}

// The number of runs of adjacent samples in a set.
float run_count(uvec2 samples) {
  return count_of(samples & ~(samples << 1u | uvec2(0u, samples.x >> 31u)));
}

// Whether the samples of a layer tell which directions are unobserved. Only the last layer's do.
bool tells_unobserved(uint layer) { return layer == (kSecondLayer ? 1u : 0u); }

// Adds a sample. `connected` tells whether it continues the surface of the last sample. If it does
// not, its surface begins at an edge, `edge` before it.
void add_sample(inout SegmentState state, float sectors, uint layer, uint k, SliceSample here,
                bool connected, float edge) {
  bool inside = within_radius(here);
  float x = connected ? here.point.x : here.point.x - edge;
  state.begin = connected ? state.begin : x;
  float scale = 1.0 / (x + abs(here.point.y));
  float height = here.point.y * scale;
  uint front = biased_position(sectors, height);
  uint beyond = sectors_beyond(front);
  // An occluder is at most as thick as it is seen to be wide.
  float thickness = min(parameters.thickness * here.point.z, here.point.x - state.begin);
  uint back = biased_position(sectors, height_of_back(height, scale, thickness));
  if (kBackFaces && here.back.y < kNoBack) {
    back = biased_position(sectors, 1.0 - diamond_angle(here.back));
    state.known_back = true;
  }
  state.occluded |= inside ? beyond ^ sectors_beyond(back) : 0u;
  // The sky continues no surface and hides nothing, even if it lies next to a surface without a
  // discontinuity, as at a horizon that is seen from within the radius.
  bool drawn = !is_sky_sample(here);
  state.occluded |= connected && state.inside && drawn ? beyond ^ state.beyond : 0u;
  bool nearer = here.point.y > 0.0 && drawn;
  // A sample is part of an occluder run if it stands above the tangent plane by more than a sector,
  // and lies within the radius or nearer to the eye than the shaded point.
  bool hides = front < kPositionBits + kSectorCount && (inside || nearer);
  add_to_set(state.runs, k, hides);
  state.half_width += hides ? state.half_interval : 0.0;
  if (tells_unobserved(layer)) add_to_set(state.unobserved, k, !inside && nearer);
  state.beyond = beyond;
  state.inside = inside;
}

DepthDiscontinuity discontinuity_between(float rise_before, float half_before, float rise_after,
                                         float half_after) {
  return depth_discontinuity(rise_before, half_before, rise_after, half_after,
                             2.0 * kDepthDiscontinuity);
}

// The distance from a sample back to the edge of its surface, if the surface does not continue that
// of the previous sample.
float edge_distance(SegmentState state) { return 2.0 * kEdgeShare * state.half_interval; }

// Adds the sample `here` (any but the first), then sets `here` to the following sample. Whether
// `here` is connected to the previous sample depends on the change of slope at `here`, for which
// the following sample is needed.
void pass_sample(inout SegmentState state, inout SliceSample here, HalfSlice half_slice,
                 float sectors, uint layer, uint k) {
  float half_interval = state.half_interval + half_slice.growth;
  SliceSample next = fetch_sample(half_slice, layer, 2.0 * half_interval + here.point.x);
  float rise = next.point.y - here.point.y;
  DepthDiscontinuity discontinuity =
      discontinuity_between(state.rise, state.half_interval, rise, half_interval);
  bool connected = layer == 0u ? samples_are_connected(state.discontinuity, discontinuity)
                               : hidden_samples_are_connected(state.discontinuity, discontinuity);
  add_sample(state, sectors, layer, k, here, connected, edge_distance(state));
  state.rise = rise;
  state.half_interval = half_interval;
  state.discontinuity = discontinuity;
  here = next;
}

// The state after the first sample. Sets `here` to the second one.
SegmentState first_state(HalfSlice half_slice, float sectors, uint layer, out SliceSample here) {
  float first_offset = sample_offset(half_slice, 0.0);
  float half_interval = first_half_interval(half_slice);
  SliceSample first = fetch_sample(half_slice, layer, first_offset);
  here = fetch_sample(half_slice, layer, 2.0 * half_interval + first_offset);
  SegmentState state;
  state.occluded = 0u;
  state.begin = 0.0;
  state.runs = uvec2(0u);
  state.half_width = 0.0;
  state.unobserved = uvec2(0u);
  state.known_back = false;
  state.beyond = 0u;
  state.inside = false;
  state.half_interval = 0.5 * first_offset;
  // The first sample continues the surface itself if it lies on its tangent plane.
  bool connected = !stands_above_tangent(first.point.xy, half_slice.height);
  add_sample(state, sectors, layer, 0u, first, connected, edge_distance(state));
  state.rise = here.point.y - first.point.y;
  state.discontinuity =
      discontinuity_between(first.point.y, state.half_interval, state.rise, half_interval);
  state.half_interval = half_interval;
  return state;
}

// The sectors that a surface occludes beyond the image's border. A surface that leaves the image
// without a discontinuity continues as the plane through its last two samples. Its slope relative
// to the tangent plane is measured between the texels of these samples, because rounding the
// positions to texels changes their distance by up to a pixel. Two samples of one texel have no
// slope.
uint extrapolated_sectors(SegmentState state, HalfSlice half_slice, float sectors,
                          SliceSample last) {
  SearchLine search_line = half_slice.search_line;
  float interval = 2.0 * state.half_interval;
  float between_texels = place_distance(half_slice, last.point.x - interval, last.point.x);
  float above_tangent = (state.rise - interval * search_line.tangent_rise) /
                        max(between_texels, 0.5 * search_line.offset_per_px);
  float slope = search_line.tangent_rise + above_tangent;
  float way =
      extrapolated_way(last.inverse_depth * search_line.y_per_depth, slope - search_line.level_rise,
                       extrapolated_distance(half_slice), kPerspective);
  vec2 end = vec2(last.point.x + way, last.point.y + slope * way);
  bool has_slope = between_texels > 0.5 * search_line.offset_per_px;
  bool continues = has_slope && way > 0.0 && !is_discontinuous(state.discontinuity) && state.inside;
  uint beyond = sectors_beyond(biased_position(sectors, 1.0 - diamond_angle(end)));
  return continues ? state.beyond ^ beyond : 0u;
}

// The fraction of the volume behind the occluders that counts as occluded. `last` is the offset of
// the last sample.
float hidden_occlusion_of(SegmentState state, HalfSlice half_slice, float last) {
  bool from_start = (state.runs.x & 1u) != 0u || state.runs == uvec2(0u);
  float before_first = from_start ? 0.0 : sample_offset(half_slice, first_sample(state.runs) - 1.0);
  float run_width = 2.0 * state.half_width / max(run_count(state.runs), 1.0);
  return hidden_occlusion_behind(run_width, before_first, last, parameters.hidden_exponent);
}

// The unobserved columns of a half-slice.
Unobserved unobserved_columns(uvec2 samples, HalfSlice half_slice) {
  bool none = samples == uvec2(0u);
  float first_k = first_sample(samples);
  float count = count_of(samples);
  Unobserved unobserved = nothing_unobserved();
  unobserved.first = none ? kNowhere : sample_offset(half_slice, first_k);
  // The width of the unobserved samples if all of them were adjacent to the first one.
  unobserved.width = max(
      half_slice.growth * count * (2.0 * (first_k + half_slice.step_offset) + count - 2.0), 0.0);
  unobserved.rows = run_count(samples);
  return unobserved;
}

// The occluders that the samples of one depth layer show.
Occluders find_in_layer(HalfSlice half_slice, float sectors, uint layer) {
  SliceSample here;
  SegmentState state = first_state(half_slice, sectors, layer, here);
  const uint rest = ((layer == 0u ? kStepCount : kSecondStepCount) - 2u) % kUnrolled;
  [[unroll]] for (uint i = 0u; i < rest; ++i) {
    pass_sample(state, here, half_slice, sectors, layer, 1u + i);
  }
  uint last = half_slice.steps - 1u;
  uint k = 1u + rest;
  while (k < last) {
    [[unroll]] for (uint i = 0u; i < kUnrolled; ++i) {
      pass_sample(state, here, half_slice, sectors, layer, k + i);
    }
    k += kUnrolled;
  }
  // No sample follows the last one, so it is connected only if there is no discontinuity before it.
  add_sample(state, sectors, layer, last, here, !is_discontinuous(state.discontinuity),
             edge_distance(state));
  uint extrapolated = extrapolated_sectors(state, half_slice, sectors, here);
  Occluders found;
  found.occluded = state.occluded | extrapolated;
  found.hidden_occlusion = hidden_occlusion_of(state, half_slice, here.point.x);
  found.known_back = state.known_back;
  found.unobserved = nothing_unobserved();
  if (tells_unobserved(layer)) found.unobserved = unobserved_columns(state.unobserved, half_slice);
  found.border = extrapolated != 0u || is_sky_sample(here) ? kNowhere : here.point.x;
  return found;
}

// The occluders that all depth layers show.
Occluders find_occluders(HalfSlice half_slice, float sectors) {
  Occluders found = Occluders(0u, 0.0, false, nothing_unobserved(), 0.0);
  if (is_empty(half_slice)) return found;
  found = find_in_layer(half_slice, sectors, 0u);
  if (kSecondLayer) {
    Occluders behind = find_in_layer(with_second_steps(half_slice), sectors, 1u);
    found.occluded |= behind.occluded;
    found.unobserved = behind.unobserved;
  }
  return found;
}

// The arc of unobserved directions before the first occluder, which begins at `first_light`.
UnobservedArc find_unobserved(HalfSlice half_slice, vec2 first_light, Occluders found) {
  float radius = half_slice.search_line.radius;
  vec2 outside = outside_parts(half_slice);
  float nearness = kPerspective ? parameters.radius * half_slice.inverse_depth : 0.0;
  Unobserved unobserved = add_beyond_border(mean_row(found.unobserved), found.border,
                                            outside.x * radius, border_share(outside.y, nearness));
  return make_unobserved_arc(first_light, unobserved, radius);
}

// A half-slice after its search: what is visible of it.
struct SearchedPart {
  Occluders found;
  vec2 first_light;  // sine and cosine of the angle at which the first occluder begins
  float sectors;     // number of sectors per unit of diamond angle
  float beyond;      // visible share of the directions beyond the start of the first occluder
  UnobservedArc unobserved;  // a share of these directions is left out
};

SearchedPart search_half_slice(HalfSlice half_slice, Slice slice) {
  float tangent_angle = tangent_diamond_angle(slice, half_slice.side);
  SearchedPart part;
  part.found = find_occluders(half_slice, 1.0 / tangent_angle);
  float sector = tangent_angle * (1.0 / float(kSectorCount));
  part.sectors = 1.0 / sector;
  part.first_light =
      part.found.occluded == 0u
          ? tangent_light(slice, half_slice.side)
          : diamond_angle_light(small_float(lowest_bit(part.found.occluded)) * sector);
  part.beyond = (1.0 - part.found.hidden_occlusion) * visible_share_beyond(part.found.occluded);
  part.unobserved = find_unobserved(half_slice, part.first_light, part.found);
  return part;
}

// Adds the visible part of the GGX lobe. The lobe is made after the search, during which it would
// hold registers.
void add_connected_lobe(inout SliceSum sum, HalfSlice half_slice, Slice slice, SearchedPart part) {
  HalfLobe lobe = make_half_lobe(slice, half_slice.side, sum.roughness * sum.roughness);
  float arc = part.found.occluded == 0u ? lobe.whole : lobe_light_arc(lobe, part.first_light);
  sum.lobe.open += lobe.whole;
  if (kBackFaces && part.found.known_back) {
    sum.lobe.visible += visible_lobe(lobe, part.sectors, repeat_last_sector(part.found.occluded),
                                     part.found.hidden_occlusion);
  } else {
    sum.lobe.visible += arc + part.beyond * (lobe.whole - arc);
  }
  float left_out = unobserved_lobe(part.unobserved, lobe, arc);
  sum.lobe.visible -= left_out;
  sum.lobe.open -= left_out;
}

// Adds the visible part of a half-slice. A share of its unobserved directions is left out.
void add_connected(inout SliceSum sum, HalfSlice half_slice, Slice slice) {
  SearchedPart part = search_half_slice(half_slice, slice);
  float open = open_arc(slice, half_slice.side);
  float arc =
      part.found.occluded == 0u ? open : light_arc(slice, half_slice.side, part.first_light);
  float left_out = unobserved_part(part.unobserved, slice, half_slice.side, arc);
  if (kBackFaces && part.found.known_back) {
    // Back faces show which directions behind an occluder are visible. They are integrated exactly.
    VisiblePart visible =
        visible_part(slice, half_slice.side, part.sectors, repeat_last_sector(part.found.occluded),
                     part.found.hidden_occlusion, kBentNormal);
    add_arc(sum, visible.arc, open, left_out);
    sum.bent += visible.bent;
  } else {
    // The arc up to the first occluder is visible. The visible sectors beyond it count as a share
    // of the rest of the open arc, reduced by the hidden occlusion.
    add_arc(sum, arc + part.beyond * (open - arc), open, left_out);
    if (kBentNormal) {
      vec2 bent = bent_light_arc(slice, half_slice.side, part.first_light);
      vec2 unoccluded =
          bent_light_arc(slice, half_slice.side, tangent_light(slice, half_slice.side));
      sum.bent += bent + part.beyond * (unoccluded - bent);
    }
  }
  if (kLobe) add_connected_lobe(sum, half_slice, slice, part);
}

#endif
