#ifndef ALCOVE_NORMALS_PARAMETERS_H
#define ALCOVE_NORMALS_PARAMETERS_H

#include "maths/projection.h"

ALCOVE_MATHS_BEGIN

struct NormalsParameters {
  Projection projection;
};

ALCOVE_MATHS_END

#endif
