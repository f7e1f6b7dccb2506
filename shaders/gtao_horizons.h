// Part of gtao.comp: the estimator `horizons` [Jimenez 2016, section 4]. Occluders are infinitely
// thick, so that everything between the highest sample and the tangent plane is occluded.
#ifndef ALCOVE_GTAO_HORIZONS_H
#define ALCOVE_GTAO_HORIZONS_H

#include "gtao_search_line.h"
#include "gtao_slice_sum.h"
#include "maths/gtao.h"
#include "maths/lobe_slice.h"
#include "maths/visibility_bitmask.h"

// Stands for the cosine of the horizon of a half-slice without occluders. It is below every cosine.
const float kNoHorizon = -2.0;

// The cosine of the angle between the view direction and a sample; kNoHorizon beyond the radius.
float sample_cosine(SliceSample here) {
  vec2 point = here.point.xy;
  return within_radius(here) ? point.y * inversesqrt(max(squared_length(point), 1e-30))
                             : kNoHorizon;
}

// Adds the part of a half-slice between the view direction and a horizon, given by its cosine.
void add_up_to_horizon(inout SliceSum sum, HalfSlice half_slice, Slice slice, float horizon) {
  vec2 light = horizon_light(slice, half_slice.side, horizon);
  if (kUniform)
    add_arc(sum, uniform_arc(light), uniform_arc(tangent_light(slice, half_slice.side)), 0.0);
  else
    add_arc(sum, light_arc(slice, half_slice.side, light), open_arc(slice, half_slice.side), 0.0);
  if (kBentNormal) sum.bent += bent_light_arc(slice, half_slice.side, light);
  if (kLobe) {
    HalfLobe lobe = make_half_lobe(slice, half_slice.side, sum.roughness * sum.roughness);
    sum.lobe.open += lobe.whole;
    sum.lobe.visible += lobe_light_arc(lobe, light);
  }
}

// Adds the visible part of a half-slice.
void add_horizons(inout SliceSum sum, HalfSlice half_slice, Slice slice) {
  float horizon = kNoHorizon;
  uint k = is_empty(half_slice) ? kStepCount : 0u;
  while (k < kStepCount) {
    SliceSample here = fetch_sample(half_slice, 0u, sample_offset(half_slice, float(k)));
    horizon = max(horizon, sample_cosine(here));
    ++k;
  }
  add_up_to_horizon(sum, half_slice, slice, horizon);
}

#endif
