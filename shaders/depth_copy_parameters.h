#ifndef ALCOVE_DEPTH_COPY_PARAMETERS_H
#define ALCOVE_DEPTH_COPY_PARAMETERS_H

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

// The parameters of copy_depth.comp and mask_depth.comp. Only the latter reads the last three.
struct DepthCopyParameters {
  ivec2 first;         // the first pixel that is copied
  ivec2 size;          // the number of pixels that are copied
  uint not_receiving;  // bits of the mask
  uint not_occluding;  // bits of the mask
  float sky;           // raw depth of the far plane
};

ALCOVE_MATHS_END

#endif
