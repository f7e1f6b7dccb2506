#ifndef ALCOVE_GTSO_PARAMETERS_H
#define ALCOVE_GTSO_PARAMETERS_H

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

struct GtsoParameters {
  // Areas for areas.h, read only with kAreas.
  ivec4 area;             // that is read: its position in the inputs (xy) and its size (zw)
  ivec4 written;          // the first pixel that is written (xy), and the last (zw)
  mat4 view_from_normal;  // rotation from the space of the normals to view space
  vec4 slope;             // xy: ray_per_px(); zw: of the ray at the image's corner; view space
  vec2 inverse_depth_from_ndc;  // of inverse_depth_of_ndc()
  ivec2 to_outputs;             // from pixels to the outputs, for areas.h
  float roughness;              // perceptual; used if there is no roughness texture
};

ALCOVE_MATHS_END

#endif
