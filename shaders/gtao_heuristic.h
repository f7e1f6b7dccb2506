// Part of gtao.comp: the paper's heuristic for thin occluders (Jimenez et al. 2016, section 4.2).
// It finds horizons as gtao_horizons.h does, but lets each lower sample pull the horizon down.
#ifndef ALCOVE_GTAO_HEURISTIC_H
#define ALCOVE_GTAO_HEURISTIC_H

float lower_horizon(float horizon, float found) {
  return raise_horizon(horizon, found, parameters.blend);
}

#endif
