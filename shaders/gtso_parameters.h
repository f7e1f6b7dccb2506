#ifndef ALCOVE_GTSO_PARAMETERS_H
#define ALCOVE_GTSO_PARAMETERS_H

#include "maths/projection.h"

ALCOVE_MATHS_BEGIN

struct GtsoParameters {
  // These two are read only with kAreas.
  ivec4 origins;  // of the area that is read, in normal_image (xy) and in roughness_image (zw)
  ivec4 written;  // xy: the first pixel that is written; zw: from pixels to the output images
  Projection projection;
  mat4 view_from_normal;  // rotation from the space of the normals to view space
  ivec2 size_px;          // of the area that is written
  float roughness;        // perceptual; used if there is no roughness texture
};

ALCOVE_MATHS_END

#endif
