#ifndef ALCOVE_INVERSE_DEPTH_PARAMETERS_H
#define ALCOVE_INVERSE_DEPTH_PARAMETERS_H

#include "maths/slice_line.h"

ALCOVE_MATHS_BEGIN

struct InverseDepthParameters {
  InverseDepthFromNdc inverse_depth_from_ndc;
};

ALCOVE_MATHS_END

#endif
