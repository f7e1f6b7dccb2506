#ifndef ALCOVE_DEPTH_PYRAMID_PARAMETERS_H
#define ALCOVE_DEPTH_PYRAMID_PARAMETERS_H

#include "maths/projection.h"

ALCOVE_MATHS_BEGIN

struct LinearDepthParameters {
  Projection projection;
  float reach;  // scene units, see maths/pyramid.h
};

ALCOVE_MATHS_END

#endif
