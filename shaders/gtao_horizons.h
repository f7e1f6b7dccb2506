// Part of gtao.comp: the paper's estimator, horizons of infinitely thick occluders (Jimenez et al.
// 2016, section 4).
#ifndef ALCOVE_GTAO_HORIZONS_H
#define ALCOVE_GTAO_HORIZONS_H

#include "gtao_heuristic.h"

// The cosine of the horizon after one more sample of its half-slice.
float next_horizon(float horizon, HalfSlice half_slice, vec3 point) {
  float squared = squared_length(point.xy);
  float radius = half_slice.radius * point.z;
  float inverse = inversesqrt(max(squared, 1e-30));
  float found = point.y * inverse;
  if (kFalloff) {
    found = mix(half_slice.tangent_cosine, found,
                radius_weight(squared * inverse, radius, parameters.falloff));
  }
  float next = kHeuristic ? lower_horizon(horizon, found) : max(horizon, found);
  return squared <= radius * radius ? next : horizon;
}

// Cosine of the horizon within the radius in a half-slice; -1 where there is none.
float find_horizon(HalfSlice half_slice) {
  float horizon = -1.0;
  uint k = 0;
  do {
    horizon = next_horizon(horizon, half_slice, fetch_sample(half_slice, 0u, k).point);
    ++k;
  } while (k < kStepCount);
  return half_slice.reach_px > 0.0 ? horizon : -1.0;
}

// Adds the part of a half-slice that its horizon leaves visible.
void add_horizon(inout SliceSum sum, HalfSlice half_slice, Slice slice, LobeSlice lobe) {
  vec2 light = horizon_light(slice, half_slice.side, find_horizon(half_slice));
  sum.visible += part_arc(slice, half_slice.side, light, kUniformWeight);
  if (kBentNormal) sum.bent += bent_light_arc(slice, half_slice.side, light);
  if (kLobe) sum.lobe.visible += lobe_light_arc(lobe, half_slice.side, light);
}

#endif
