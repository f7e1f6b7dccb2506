// Part of gtao.comp: the default estimator, connected samples. It finds which sectors of a
// half-slice are occluded by surfaces of finite thickness (maths/connected_samples.h) and which
// directions the depth buffer does not show (maths/unobserved.h).
//
// Sectors are a bit mask from the view direction (bit 0) to the tangent plane. An interval of
// sectors is the exclusive or of the two masks "all sectors beyond a position", in any order.
#ifndef ALCOVE_GTAO_CONNECTED_H
#define ALCOVE_GTAO_CONNECTED_H

// The state of the search between one sample and the next.
struct SegmentState {
  float rise;         // change of SliceSample::off_plane over the last sample interval
  float interval_px;  // width of the last sample interval
  DepthDiscontinuity discontinuity;  // at the last sample
  float x;                           // x (times w) of the last sample
  uint beyond;                       // sectors beyond the last sample
  bool inside;                       // whether the last sample lies within the radius
  uint occluded;                     // sectors, so far
  uint runs;                         // one bit per sample: part of an occluder run
  float run_px;                      // width of all occluder runs together
  uint unobserved;  // one bit per sample: hides what lies within the radius behind it
  bool known_back;  // whether a back face told where an occluder ends
};

// The occluders that were found in a half-slice.
struct Occluders {
  uint occluded;           // sectors
  float hidden_occlusion;  // fraction of the sectors hidden behind the first that is occluded
  bool known_back;         // whether back faces told where occluders end
  Unobserved unobserved;
  float border_px;  // offset of the last sample, or kNowherePx if what lies beyond the border is
                    // known
};

// Sample bits: with more than 32 samples, several share a bit.
uint sample_bit(uint k) { return 1u << (kStepCount <= 32u ? k : k * 32u / kStepCount); }

float first_sample(uint bits) {
  float bit = float(findLSB(bits));
  return kStepCount <= 32u ? bit : bit * (float(kStepCount) / 32.0);
}

float run_count(uint bits) { return float(bitCount(bits & ~(bits << 1u))); }

// Whether only the last layer's samples are left to tell what no layer shows.
bool tells_unobserved(uint layer) {
  return kLeaveOutUnobserved && layer == (kSecondLayer ? 1u : 0u);
}

// Adds a sample. `joined` tells whether it continues the last sample's surface, `edge_px` how far
// before the sample the surface begins if not.
void add_sample(inout SegmentState state, HalfSlice half_slice, float sectors, uint layer, uint bit,
                SliceSample here, bool joined, float edge_px) {
  bool inside = within_radius(half_slice, here);
  // A surface that begins here is drawn in up to its edge.
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
  // A run hides what lies behind it: it stands above the tangent plane by more than a sector,
  // within the radius or nearer the eye.
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

// The sectors of a surface that leaves the image without a discontinuity: it goes on as the plane
// that its last two samples lie on.
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

// Sample intervals in one iteration of the loop over samples. An iteration costs as much as half a
// sample, but each interval holds the registers of a sample. Several slices hold more registers
// than one. passes/cost/gtao.cpp counts the iterations.
const uint kUnrolled = kSliceCount > 1u ? 2u : 4u;

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
  // No sample shows how the last interval ends: the sample is joined only if its surface did not
  // bend before.
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
    // The sample intervals grow outwards; all are taken to follow the first.
    found.unobserved.width_px = max(half_slice.reach_per_step * count *
                                        (2.0 * (first_k + half_slice.step_offset) + count - 2.0),
                                    0.0);
    found.unobserved.rows = run_count(state.unobserved);
  }
  bool known = extrapolated != 0u || here.inverse_depth == sky_inverse_depth(kPerspective);
  found.border_px = known ? kNowherePx : here.offset_px;
  if (half_slice.reach_px <= 0.0)
    found = Occluders(0u, 0.0, false, nothing_unobserved(), found.border_px);
  return found;
}

Occluders find_occluders(HalfSlice half_slice, float sectors) {
  Occluders found = find_in_layer(half_slice, sectors, 0u);
  if (kSecondLayer) {
    Occluders behind = find_in_layer(half_slice, sectors, 1u);
    found.occluded |= behind.occluded;
    found.unobserved = behind.unobserved;
  }
  return found;
}

UnobservedArc find_unobserved(HalfSlice half_slice, vec2 first_light, float other_outside,
                              Occluders found) {
  Unobserved unobserved = add_beyond_border(mean_row(found.unobserved), found.border_px,
                                            half_slice.outside * half_slice.radius_px,
                                            border_share(other_outside, half_slice.nearness));
  return make_unobserved_arc(first_light, unobserved, half_slice.radius_px);
}

// Adds the visible part of a half-slice, less a share of its unobserved directions.
// `open_arc` is the half-slice's part when nothing occludes it, `other_border_px` the distance to
// the image's border in the other half-slice.
void add_connected(inout SliceSum sum, HalfSlice half_slice, Slice slice, LobeSlice lobe,
                   float open_arc, float other_border_px) {
  vec2 tangent = tangent_light(slice, half_slice.side);
  float tangent_angle = tangent_diamond_angle(slice, half_slice.side);
  Occluders found = find_occluders(half_slice, 1.0 / tangent_angle);
  bool open = found.occluded == 0u;
  float sector = tangent_angle * (1.0 / float(kEvenSectorCount));
  vec2 first_light = open ? tangent : diamond_angle_light(float(findLSB(found.occluded)) * sector);
  float arc = open ? open_arc : part_arc(slice, half_slice.side, first_light, kUniformWeight);
  if (kBackFaces && found.known_back) {
    // Back faces show which directions behind an occluder are visible: they are integrated exactly.
    VisiblePart part =
        visible_part(slice, half_slice.side, 1.0 / sector, repeat_last_sector(found.occluded),
                     found.hidden_occlusion, PartRequest(kUniformWeight, kBentNormal));
    sum.visible += part.arc;
    sum.bent += part.bent;
  } else {
    // Everything is visible up to the first occluder. Beyond it the visible sectors count, less the
    // hidden occlusion, as a share of the whole arc that is left.
    float beyond = (1.0 - found.hidden_occlusion) * visible_share_beyond(found.occluded);
    sum.visible += arc + beyond * (open_arc - arc);
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
    UnobservedArc unobserved = find_unobserved(
        half_slice, first_light, outside_share(other_border_px, half_slice.radius_px), found);
    sum.left_out += unobserved.share *
                    (arc - part_arc(slice, half_slice.side, unobserved.from, kUniformWeight));
    if (kLobe) sum.lobe_left_out += unobserved_lobe(unobserved, lobe, half_slice.side);
  }
}

#endif
