#ifndef ALCOVE_LINEAR_DEPTH_PARAMETERS_H
#define ALCOVE_LINEAR_DEPTH_PARAMETERS_H

#include "maths/projection.h"

ALCOVE_MATHS_BEGIN

struct LinearDepthParameters {
  Projection projection;
  ivec2 origin;  // of the area of depth_ndc_image that is read
};

ALCOVE_MATHS_END

#endif
