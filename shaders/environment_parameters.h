#ifndef ALCOVE_ENVIRONMENT_PARAMETERS_H
#define ALCOVE_ENVIRONMENT_PARAMETERS_H

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

// Parameters of the environment passes. Each pass reads the fields that it needs.
struct EnvironmentParameters {
  vec2 source_px;   // size of the source image in texels
  float size;       // width of the written mip in texels
  float samples;    // per axis of a texel (resampling), or per lobe (prefiltering)
  float roughness;  // perceptual, of the written mip
  float levels;     // number of mips of the source
};

ALCOVE_MATHS_END

#endif
