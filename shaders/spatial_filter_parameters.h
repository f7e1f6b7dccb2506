#ifndef ALCOVE_SPATIAL_FILTER_PARAMETERS_H
#define ALCOVE_SPATIAL_FILTER_PARAMETERS_H

#include "maths/projection.h"

ALCOVE_MATHS_BEGIN

struct SpatialFilterParameters {
  Projection projection;
  mat4 view_from_normal;  // rotation from the space of the normals to view space
  float tolerance_px;     // distance from the tangent plane at which a weight is 0, in pixel sizes
};

ALCOVE_MATHS_END

#endif
