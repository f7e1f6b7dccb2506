#ifndef ALCOVE_RECONSTRUCT_PARAMETERS_H
#define ALCOVE_RECONSTRUCT_PARAMETERS_H

#include "maths/projection.h"

ALCOVE_MATHS_BEGIN

struct ReconstructParameters {
  Projection projection;
  Projection previous;          // of the frame before
  mat4 view_from_normal;        // rotation from the space of the normals to view space
  mat4 previous_view_from_view;  // from this frame's view space to the previous one's
  vec2 phase;                   // which pixel of each block was searched this frame
  float tolerance_px;           // distance from the tangent plane where a weight is 0, in pixel sizes
  float longest;                // frames that history counts at most
  float clamp_width;            // history is held to so many deviations of this frame's neighbourhood
  uint history_valid;           // 0 or 1
};

ALCOVE_MATHS_END

#endif
