// Declarations that the shader of the picture pass, which shows a texture in the window, shares
// with C++.
#ifndef ALCOVE_SAMPLE_SHADERS_PICTURE_H_
#define ALCOVE_SAMPLE_SHADERS_PICTURE_H_

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

// How the texels of a texture are converted to colours.
const uint kShowGrey = 0u;       // one channel, unchanged
const uint kShowColour = 1u;     // three channels, unchanged
const uint kShowDirection = 2u;  // a unit vector: each component from -1..1 to 0..1
const uint kShowDepth = 3u;      // a distance: 0 at the eye, 0.5 at `scale`
const uint kShowMotion = 4u;     // in uv: red to the right, green downwards, 0.5 without motion
const uint kShowRadiance = 5u;   // as in the lit.png that `alcove render` writes

struct PictureParameters {
  mat4 world_from_shown;  // of directions: from their space to world space
  uint show;              // one of the constants above
  float split;            // x coordinate in pixels from which the second texture is shown
  float scale;  // of depth, scene units; of motion, 1 / the uv that is fully coloured; of radiance,
                // the exposure
  float band;   // width of the guard band in pixels, which is not shown
};

ALCOVE_MATHS_END

#endif  // ALCOVE_SAMPLE_SHADERS_PICTURE_H_
