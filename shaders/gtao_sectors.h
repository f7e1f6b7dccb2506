// The bitmask part of gtao.comp, which includes it: which sectors of a side the samples occlude,
// joined into segments (maths/connected_samples.h) or each by itself, and what of it they do not
// show (maths/unobserved.h).
#ifndef ALCOVE_GTAO_SECTORS_H
#define ALCOVE_GTAO_SECTORS_H

// What a side shows that rays pass behind: a front is a row of columns whose samples is_front().
struct Fronts {
  float count;
  float width_px;   // of all together
  float before_px;  // the way before the first
  bool last;        // whether the last column is of one
};

// What the search holds on to from sample to sample.
struct ConnectedSegment {
  vec3 last;              // the last sample's point
  float rise;             // of `line` over the last step
  float step_px;          // the last step
  float discontinuity;    // sharp, at the last sample
  float position;         // of the last sample's front, in sectors
  float excess;           // radius_excess() of it
  uint occluded;          // sectors, so far
  Fronts fronts;          // so far
  Unobserved unobserved;  // so far
};

// Where the occluder at a sample ends. One that begins there has so much drawn in before it.
float back_position(Search search, SliceSample here, bool begins, float drawn) {
  float thickness = sample_thickness(settings_thickness(here), begins, drawn);
  bool known = kBackFaces && here.back.y < kNoBack;
  vec2 back = known ? here.back : here.point.xy - vec2(0.0, thickness);
  return sector_position(search.per_diamond_angle, back);
}

// Whether rays beside the surface pass behind a sample: it stands above the tangent plane by more
// than a sector, within the radius or nearer the eye.
bool is_front(SliceSample here, float excess, float position) {
  return position < float(kSectorCount - 1u) && (excess <= 0.0 || here.point.y > 0.0);
}

// Columns stand next to each other: `width_px` is this one's, which ends at `end_px`.
Fronts add_column(Fronts fronts, bool front, float width_px, float end_px) {
  fronts.count += front && !fronts.last ? 1.0 : 0.0;
  fronts.width_px += front ? width_px : 0.0;
  fronts.before_px = fronts.count > 0.0 ? fronts.before_px : end_px;
  fronts.last = front;
  return fronts;
}

// The mean width of a front, in parts of the way from the first on.
float front_width(Fronts fronts, float way_px) {
  return fronts.width_px / (max(fronts.count, 1.0) * max(way_px - fronts.before_px, 1e-3));
}

// Only the last layer's samples tell what none shows.
bool tells_unobserved(uint layer) {
  return kLeaveOutUnobserved && layer == (kSecondLayer ? 1u : 0u);
}

// `excess` is the sample's, `width_px` that of the column it stands for.
Unobserved pass_column(Unobserved unobserved, SliceSample here, float excess, float width_px) {
  bool hides = excess > 0.0 && here.point.y > 0.0;
  return add_column(unobserved, hides, here.offset_px, width_px);
}

// The first sample stands alone. Its edge is drawn in unless it lies on the surface's own plane.
ConnectedSegment begin_segment(Search search, uint layer, SliceSample here, SliceSample next) {
  ConnectedSegment segment;
  segment.last = here.point;
  segment.rise = next.inverse_depth - here.inverse_depth;
  segment.step_px = next.offset_px - here.offset_px;
  segment.discontinuity =
      depth_discontinuity(here.inverse_depth - search.tangent.inverse_depth, here.offset_px,
                          segment.rise, segment.step_px, search.sharp);
  float height = dot(here.point.xy, search.height);
  bool above = height * abs(height) > 0.04 * squared_length(here.point.xy);
  bool begins = kConnected && above;
  float drawn = begins ? edge_share(kStepCount) * here.point.x : 0.0;
  segment.position = sector_position(search.per_diamond_angle, here.point.xy - vec2(drawn, 0.0));
  segment.excess = radius_excess(here.point, parameters.radius);
  float end = back_position(search, here, begins, drawn);
  uint covered = sectors_between(segment.position, end);
  segment.occluded = segment.excess <= 0.0 ? covered : 0u;
  bool front = is_front(here, segment.excess, segment.position);
  segment.fronts = add_column(Fronts(0.0, 0.0, 0.0, false), front, here.offset_px, here.offset_px);
  segment.unobserved = nothing_unobserved();
  if (tells_unobserved(layer)) {
    segment.unobserved = pass_column(segment.unobserved, here, segment.excess, here.offset_px);
  }
  return segment;
}

// Adds a sample, `discontinuity` of the line at it: its thickness, and the segment between it and
// the last one if they are joined, as far as it runs within the radius.
void extend_segment(inout ConnectedSegment segment, Search search, uint layer, SliceSample here,
                    float discontinuity) {
  bool joined =
      kConnected && (layer == 0u ? samples_join(segment.discontinuity, discontinuity)
                                 : hidden_samples_join(segment.discontinuity, discontinuity));
  float excess = radius_excess(here.point, parameters.radius);
  bool inside = excess <= 0.0;
  bool begins = kConnected && !joined;
  float drawn =
      begins ? edge_share(kStepCount) * segment.step_px * search.slice_line.x_per_step : 0.0;
  vec2 front = vec2(here.point.x - drawn, here.point.y);
  vec2 leaves = radius_crossing(here.point, excess, segment.last, segment.excess);
  float position = sector_position(search.per_diamond_angle, inside ? front : leaves);
  // Not in the choice itself, which would be a branch.
  float behind = back_position(search, here, begins, drawn);
  float end = inside ? behind : position;
  bool attached = joined && segment.excess <= 0.0;
  float joint = attached ? segment.position : position;
  uint covered = sectors_from_to(min(min(position, end), joint), max(max(position, end), joint));
  segment.occluded |= inside || attached ? covered : 0u;
  segment.fronts =
      add_column(segment.fronts, is_front(here, excess, position), segment.step_px, here.offset_px);
  if (tells_unobserved(layer)) {
    segment.unobserved = pass_column(segment.unobserved, here, excess, segment.step_px);
  }
  segment.last = here.point;
  segment.discontinuity = discontinuity;
  segment.position = position;
  segment.excess = excess;
}

// Adds `here`, now that the sample `next` after it tells how the line bends at it.
void pass_sample(inout ConnectedSegment segment, inout SliceSample here, Search search, uint layer,
                 SliceSample next) {
  float rise = next.inverse_depth - here.inverse_depth;
  float step_px = next.offset_px - here.offset_px;
  float discontinuity =
      depth_discontinuity(segment.rise, segment.step_px, rise, step_px, search.sharp);
  extend_segment(segment, search, layer, here, discontinuity);
  segment.rise = rise;
  segment.step_px = step_px;
  here = next;
}

// Those of a surface that leaves the image and did not discontinuity before: it is taken to go on
// as it left, until it leaves the radius. `way` is the last step's.
uint extrapolated_sectors(ConnectedSegment segment, Search search, vec3 way) {
  float x = search.extrapolated_px * search.slice_line.x_per_step;
  vec3 end = extrapolated_point(segment.last, way, x);
  float excess = radius_excess(end, parameters.radius);
  vec2 leaves = radius_crossing(end, excess, segment.last, segment.excess);
  float position = sector_position(search.per_diamond_angle, excess > 0.0 ? leaves : end.xy);
  bool goes_on = x > 0.0 && segment.discontinuity == 0.0 && segment.excess <= 0.0;
  return goes_on ? sectors_between(segment.position, position) : 0u;
}

// Samples that are searched in one turn of the loop: a turn costs as much as half a sample, and all
// in one would be a program of thousands of lines.
const uint kTurn = 4;

// What was found on a side.
struct Occluders {
  uint occluded;           // sectors
  float hidden_occlusion;  // of what is behind them
  Unobserved unobserved;
  float border_px;  // of the last sample, if nothing is known to go on beyond the image; else
                    // kNowherePx
};

Occluders find_in_layer(Search search, uint layer) {
  SliceSample here = fetch_sample(search, layer, 1);
  ConnectedSegment segment = begin_segment(search, layer, fetch_sample(search, layer, 0), here);
  const uint rest = (kStepCount - 2) % kTurn;
  uint k = 2;
  [[unroll]] for (uint i = 0; i < rest; ++i) {
    pass_sample(segment, here, search, layer, fetch_sample(search, layer, k + i));
  }
  k += rest;
  if (k < kStepCount) {
    do {
      [[unroll]] for (uint i = 0; i < kTurn; ++i) {
        pass_sample(segment, here, search, layer, fetch_sample(search, layer, k + i));
      }
      k += kTurn;
    } while (k < kStepCount);
  }
  // Nothing tells how it ends: joined only if the way to it did not discontinuity.
  vec3 way = here.point - segment.last;
  extend_segment(segment, search, layer, here, -segment.discontinuity);
  uint continued = kExtrapolation && kConnected ? extrapolated_sectors(segment, search, way) : 0u;
  float width = front_width(segment.fronts, kNearestStep + search.reach_px);
  float hidden_occlusion = hidden_occlusion_behind(width, parameters.hidden_occlusion);
  Occluders found =
      Occluders(segment.occluded | continued, hidden_occlusion, segment.unobserved, 0.0);
  if (search.reach_px <= 0.0) found = Occluders(0u, 0.0, nothing_unobserved(), 0.0);
  bool known = continued != 0u || here.inverse_depth == sky_inverse_depth(kPerspective);
  found.border_px = known ? kNowherePx : here.offset_px;
  return found;
}

Occluders find_occluders(Search search) {
  Occluders found = find_in_layer(search, 0u);
  if (kSecondLayer) {
    Occluders behind = find_in_layer(search, 1u);
    found.occluded |= behind.occluded;
    found.unobserved = behind.unobserved;
  }
  return found;
}

#endif
