// Part of gtao.comp: the estimator `heuristic`, the paper's treatment of thin occluders [Jimenez
// 2016, section 4.2]. It finds a horizon as gtao_horizons.h does, but each sample below the horizon
// pulls it down by the fraction AdvancedSettings::blend.
#ifndef ALCOVE_GTAO_HEURISTIC_H
#define ALCOVE_GTAO_HEURISTIC_H

#include "gtao_horizons.h"

// Adds the visible part of a half-slice.
void add_heuristic(inout SliceSum sum, HalfSlice half_slice, Slice slice) {
  float horizon = -1.0;
  uint k = 0u;
  do {
    float cosine = sample_cosine(
        half_slice, fetch_sample(half_slice, 0u, sample_offset(half_slice, float(k))).point);
    horizon = cosine == kNoHorizon ? horizon : raise_horizon(horizon, cosine, parameters.blend);
    ++k;
  } while (k < kStepCount);
  add_up_to_horizon(sum, half_slice, slice, horizon);
}

#endif
