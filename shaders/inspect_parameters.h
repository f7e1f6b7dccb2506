// The uniform block of inspect.comp, shared by GLSL and C++.
#ifndef ALCOVE_INSPECT_PARAMETERS_H_
#define ALCOVE_INSPECT_PARAMETERS_H_

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

// Width and height of the grid of sampled pixels. The image that inspect.comp writes has three
// texels for each sampled pixel, and one more row for the whole image.
const uint kInspectColumns = 64;
const uint kInspectRows = 48;

struct InspectParameters {
  uvec2 origin;   // position of the part of the images that is in use
  uvec2 size_px;  // size of the part of the image that is in use
  uint has_normals;
  uint has_motion;
};

ALCOVE_MATHS_END

#endif  // ALCOVE_INSPECT_PARAMETERS_H_
