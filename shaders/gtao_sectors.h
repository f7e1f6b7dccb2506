// The bitmask part of gtao.comp, which includes it: which sectors of a side the samples occlude,
// joined into sheets (maths/connected_samples.h) or each by itself, and what of it they do not show
// (maths/unseen.h).
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
struct Sheet {
  vec3 last;       // the last sample's point
  float rise;      // of `line` over the last step
  float step_px;   // the last step
  float bend;      // sharp, at the last sample
  float position;  // of the last sample's front, in sectors
  float excess;    // radius_excess() of it
  uint occluded;   // sectors, so far
  Fronts fronts;   // so far
  Unseen unseen;   // so far
};

// Where the occluder at a sample ends. One that begins there has so much drawn in before it.
float back_position(Search search, LineSample here, bool begins, float drawn) {
  float thickness = sample_thickness(settings_thickness(here), begins, drawn);
  bool known = kBackFaces && here.back.y < kNoBack;
  vec2 back = known ? here.back : here.point.xy - vec2(0.0, thickness);
  return sector_position(search.per_bearing, back);
}

// Whether rays beside the surface pass behind a sample: it stands above the tangent plane by more
// than a sector, within the radius or nearer the eye.
bool is_front(LineSample here, float excess, float position) {
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
bool tells_unseen(uint layer) { return kLeaveOutUnseen && layer == (kSecondLayer ? 1u : 0u); }

// `excess` is the sample's, `width_px` that of the column it stands for.
Unseen pass_column(Unseen unseen, LineSample here, float excess, float width_px) {
  bool hides = excess > 0.0 && here.point.y > 0.0;
  return add_column(unseen, hides, here.offset_px, width_px);
}

// The first sample stands alone. Its edge is drawn in unless it lies on the surface's own plane.
Sheet begin_sheet(Search search, uint layer, LineSample here, LineSample next) {
  Sheet sheet;
  sheet.last = here.point;
  sheet.rise = next.line - here.line;
  sheet.step_px = next.offset_px - here.offset_px;
  sheet.bend = sharp_bend(here.line - search.tangent.line, here.offset_px, sheet.rise,
                          sheet.step_px, search.sharp);
  float height = dot(here.point.xy, search.height);
  bool above = height * abs(height) > 0.04 * squared_length(here.point.xy);
  bool begins = kConnected && above;
  float drawn = begins ? edge_share(kStepCount) * here.point.x : 0.0;
  sheet.position = sector_position(search.per_bearing, here.point.xy - vec2(drawn, 0.0));
  sheet.excess = radius_excess(here.point, parameters.radius);
  float end = back_position(search, here, begins, drawn);
  uint covered = sectors_between(sheet.position, end);
  sheet.occluded = sheet.excess <= 0.0 ? covered : 0u;
  bool front = is_front(here, sheet.excess, sheet.position);
  sheet.fronts = add_column(Fronts(0.0, 0.0, 0.0, false), front, here.offset_px, here.offset_px);
  sheet.unseen = nothing_unseen();
  if (tells_unseen(layer)) {
    sheet.unseen = pass_column(sheet.unseen, here, sheet.excess, here.offset_px);
  }
  return sheet;
}

// Adds a sample, `bend` of the line at it: its thickness, and the sheet between it and the last one
// if they are joined, as far as it runs within the radius.
void extend_sheet(inout Sheet sheet, Search search, uint layer, LineSample here, float bend) {
  bool joined = kConnected && (layer == 0u ? samples_join(sheet.bend, bend)
                                           : hidden_samples_join(sheet.bend, bend));
  float excess = radius_excess(here.point, parameters.radius);
  bool inside = excess <= 0.0;
  bool begins = kConnected && !joined;
  float drawn =
      begins ? edge_share(kStepCount) * sheet.step_px * search.slice_line.x_per_step : 0.0;
  vec2 front = vec2(here.point.x - drawn, here.point.y);
  vec2 leaves = radius_crossing(here.point, excess, sheet.last, sheet.excess);
  float position = sector_position(search.per_bearing, inside ? front : leaves);
  // Not in the choice itself, which would be a branch.
  float behind = back_position(search, here, begins, drawn);
  float end = inside ? behind : position;
  bool attached = joined && sheet.excess <= 0.0;
  float joint = attached ? sheet.position : position;
  uint covered = sectors_from_to(min(min(position, end), joint), max(max(position, end), joint));
  sheet.occluded |= inside || attached ? covered : 0u;
  sheet.fronts =
      add_column(sheet.fronts, is_front(here, excess, position), sheet.step_px, here.offset_px);
  if (tells_unseen(layer)) {
    sheet.unseen = pass_column(sheet.unseen, here, excess, sheet.step_px);
  }
  sheet.last = here.point;
  sheet.bend = bend;
  sheet.position = position;
  sheet.excess = excess;
}

// Adds `here`, now that the sample `next` after it tells how the line bends at it.
void pass_sample(inout Sheet sheet, inout LineSample here, Search search, uint layer,
                 LineSample next) {
  float rise = next.line - here.line;
  float step_px = next.offset_px - here.offset_px;
  float bend = sharp_bend(sheet.rise, sheet.step_px, rise, step_px, search.sharp);
  extend_sheet(sheet, search, layer, here, bend);
  sheet.rise = rise;
  sheet.step_px = step_px;
  here = next;
}

// Those of a surface that leaves the image and did not bend before: it is taken to go on as it
// left, until it leaves the radius. `way` is the last step's.
uint continued_sectors(Sheet sheet, Search search, vec3 way) {
  float x = search.continued_px * search.slice_line.x_per_step;
  vec3 end = continued_point(sheet.last, way, x);
  float excess = radius_excess(end, parameters.radius);
  vec2 leaves = radius_crossing(end, excess, sheet.last, sheet.excess);
  float position = sector_position(search.per_bearing, excess > 0.0 ? leaves : end.xy);
  bool goes_on = x > 0.0 && sheet.bend == 0.0 && sheet.excess <= 0.0;
  return goes_on ? sectors_between(sheet.position, position) : 0u;
}

// Samples that are searched in one turn of the loop: a turn costs as much as half a sample, and all
// in one would be a program of thousands of lines.
const uint kTurn = 4;

// What was found on a side.
struct Occluders {
  uint occluded;  // sectors
  float fill;     // of what is behind them
  Unseen unseen;
  float border_px;  // of the last sample, if nothing is known to go on beyond the image; else
                    // kNowherePx
};

Occluders find_in_layer(Search search, uint layer) {
  LineSample here = fetch_sample(search, layer, 1);
  Sheet sheet = begin_sheet(search, layer, fetch_sample(search, layer, 0), here);
  const uint rest = (kStepCount - 2) % kTurn;
  uint k = 2;
  [[unroll]] for (uint i = 0; i < rest; ++i) {
    pass_sample(sheet, here, search, layer, fetch_sample(search, layer, k + i));
  }
  k += rest;
  if (k < kStepCount) {
    do {
      [[unroll]] for (uint i = 0; i < kTurn; ++i) {
        pass_sample(sheet, here, search, layer, fetch_sample(search, layer, k + i));
      }
      k += kTurn;
    } while (k < kStepCount);
  }
  // Nothing tells how it ends: joined only if the way to it did not bend.
  vec3 way = here.point - sheet.last;
  extend_sheet(sheet, search, layer, here, -sheet.bend);
  uint continued = kContinuation && kConnected ? continued_sectors(sheet, search, way) : 0u;
  float width = front_width(sheet.fronts, kNearestStep + search.reach_px);
  float fill = fill_behind(width, parameters.fill);
  Occluders found = Occluders(sheet.occluded | continued, fill, sheet.unseen, 0.0);
  if (search.reach_px <= 0.0) found = Occluders(0u, 0.0, nothing_unseen(), 0.0);
  bool known = continued != 0u || here.line == sky_line(kPerspective);
  found.border_px = known ? kNowherePx : here.offset_px;
  return found;
}

Occluders find_occluders(Search search) {
  Occluders found = find_in_layer(search, 0u);
  if (kSecondLayer) {
    Occluders behind = find_in_layer(search, 1u);
    found.occluded |= behind.occluded;
    found.unseen = behind.unseen;
  }
  return found;
}

#endif
