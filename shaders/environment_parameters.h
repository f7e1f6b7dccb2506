#ifndef ALCOVE_ENVIRONMENT_PARAMETERS_H
#define ALCOVE_ENVIRONMENT_PARAMETERS_H

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

// For the passes that make an environment; each reads what it needs.
struct EnvironmentParameters {
  vec2 source_px;   // size of what is read
  float size;       // texels a side of what is written
  float samples;    // a side of a texel (resampling), or of a lobe (prefiltering)
  float roughness;  // perceptual, of the level that is written
  float levels;     // of the map that is read
};

ALCOVE_MATHS_END

#endif
