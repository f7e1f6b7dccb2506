// Part of gtao.comp: the estimator `bitmask` [Therrien, Levesque and Gilet 2023]. Each sample is an
// occluder of its own, whose thickness along the view direction is that of the settings or, with
// back faces, that of the object.
#ifndef ALCOVE_GTAO_BITMASK_H
#define ALCOVE_GTAO_BITMASK_H

#include "gtao_search_line.h"
#include "gtao_slice_sum.h"
#include "maths/gtao.h"
#include "maths/lobe_slice.h"
#include "maths/visibility_bitmask.h"

// The occluder runs of a half-slice, from which hidden_occlusion_behind() is computed. Lengths are
// offsets along the line.
struct RunSum {
  float count;         // number of runs
  float width;         // of all runs together
  float before_first;  // offset of the last sample before the first run
  bool last;           // whether the last sample is part of a run
};

// Adds a sample at `offset` that is part of an occluder run if `hides` is true.
RunSum add_run_sample(RunSum runs, bool hides, float interval, float offset) {
  runs.count += hides && !runs.last ? 1.0 : 0.0;
  runs.width += hides ? interval : 0.0;
  runs.before_first = runs.count > 0.0 ? runs.before_first : offset;
  runs.last = hides;
  return runs;
}

// The sectors that the samples of one depth layer occlude.
uint occluded_by_layer(HalfSlice half_slice, float per_diamond_angle, uint layer,
                       inout RunSum runs) {
  uint occluded = 0u;
  float last = 0.0;
  uint k = is_empty(half_slice) ? kStepCount : 0u;
  while (k < kStepCount) {
    SliceSample here = fetch_sample(half_slice, layer, sample_offset(half_slice, float(k)));
    float front = sector_position(per_diamond_angle, here.point.xy);
    bool known = kBackFaces && here.back.y < kNoBack;
    vec2 back = known ? here.back : here.point.xy - vec2(0.0, settings_thickness(here));
    bool inside = within_radius(here);
    occluded |= inside ? sectors_between(front, sector_position(per_diamond_angle, back)) : 0u;
    bool hides = front < float(kSectorCount - 1u) && (inside || here.point.y > 0.0);
    if (layer == 0u) runs = add_run_sample(runs, hides, here.point.x - last, here.point.x);
    last = here.point.x;
    ++k;
  }
  return occluded;
}

// Adds the part of a half-slice that its occluded sectors leave visible.
void add_bitmask(inout SliceSum sum, HalfSlice half_slice, Slice slice) {
  float per_diamond_angle = sectors_per_diamond_angle(slice, half_slice.side);
  RunSum runs = RunSum(0.0, 0.0, 0.0, false);
  uint occluded = occluded_by_layer(half_slice, per_diamond_angle, 0u, runs);
  if (kSecondLayer) occluded |= occluded_by_layer(half_slice, per_diamond_angle, 1u, runs);
  float last = sample_offset(half_slice, float(kStepCount) - 1.0);
  float hidden_occlusion = hidden_occlusion_behind(
      runs.width / max(runs.count, 1.0), runs.before_first, last, parameters.hidden_exponent);
  VisiblePart part = visible_part(slice, half_slice.side, per_diamond_angle, occluded,
                                  hidden_occlusion, kBentNormal);
  add_arc(sum, part.arc, open_arc(slice, half_slice.side), 0.0);
  sum.bent += part.bent;
  if (kLobe) {
    HalfLobe lobe = make_half_lobe(slice, half_slice.side, sum.roughness * sum.roughness);
    sum.lobe.open += lobe.whole;
    sum.lobe.visible += visible_lobe(lobe, per_diamond_angle, occluded, hidden_occlusion);
  }
}

#endif
