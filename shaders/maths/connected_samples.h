// Occluders of finite thickness from the depth samples of one side of a slice, joined where they
// lie on one surface.
//
// A depth buffer shows fronts only. Taken as infinitely thick, thin things darken whatever is
// behind them; taken as thin, walls leak light between their samples. So two consecutive samples
// are joined into a sheet when depth alone says that they continue one surface (samples_connect),
// every sample has a thickness along its own ray, and the edge of a surface that appears between
// two samples is placed between them (kEdgeShare below). What is hidden behind a front stays
// unknown: the mean of thin and infinitely thick, `fill` of the latter, errs less than either (see
// the README's table).
#ifndef ALCOVE_MATHS_CONNECTED_SAMPLES_H
#define ALCOVE_MATHS_CONNECTED_SAMPLES_H

#include "language.h"
#include "slice.h"
#include "visibility_bitmask.h"

ALCOVE_MATHS_BEGIN

// A sample of a side: its distance from the shaded pixel along the line, and a number that is
// linear along the image of any plane: 1/depth in perspective, depth in orthographic views.
struct LineSample {
  float offset_px;  // over 0, growing from sample to sample
  float line;
};

// `line` of a sample at distance `offset_px` if it lay on the straight through two others.
ALCOVE_INLINE float extrapolate(LineSample from, LineSample through, float offset_px) {
  float run = through.offset_px - from.offset_px;
  return through.line + (through.line - from.line) * (offset_px - through.offset_px) / run;
}

// Whether samples `here` and `there`, next to each other, continue one surface. `before` is the
// sample before `here`, `after` the one after `there`. They do if the surface that leads to one of
// them reaches the other, within `tolerance` (of `line`, for a pixel), or if the two surfaces meet
// between them in a crease.
ALCOVE_INLINE bool samples_connect(LineSample before, LineSample here, LineSample there,
                                   LineSample after, float tolerance) {
  float step = there.offset_px - here.offset_px;
  float ahead = extrapolate(before, here, there.offset_px) - there.line;
  float back = here.line - extrapolate(after, there, here.offset_px);
  float allowed = tolerance * step;
  return ahead * back <= 0.0f || abs(ahead) < allowed || abs(back) < allowed;
}

// Where between two samples the edge of the second one's surface is taken to be, if they are on
// two: this part of the way back to the first. Coarser searches miss more of it.
ALCOVE_INLINE float edge_share(uint steps) { return min(3.0f / float(steps), 0.6f); }

ALCOVE_MATHS_END

#endif
