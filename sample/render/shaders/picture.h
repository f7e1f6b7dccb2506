// What the pass that shows a texture in the window shares with the C++ that records it.
#ifndef ALCOVE_SAMPLE_SHADERS_PICTURE_H_
#define ALCOVE_SAMPLE_SHADERS_PICTURE_H_

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

// How a texture is turned into a colour.
const uint kShowGrey = 0u;       // one channel, as it is
const uint kShowColour = 1u;     // three channels, as they are
const uint kShowDirection = 2u;  // a unit vector, -1..1 to 0..1
const uint kShowDepth = 3u;      // a distance, 0 at the eye, half at `scale`
const uint kShowMotion = 4u;  // in uv; red to the right, green downwards, half where nothing moves
const uint kShowRadiance = 5u;  // as `alcove render` writes lit.png, the environment behind it

struct PictureParameters {
  // Of directions: from the space they are in to world space. Of radiance: from (ndc x, ndc y, 1)
  // to the direction of that pixel's ray.
  mat4 world_from_shown;
  uint show;    // kShow...
  float split;  // the other picture begins at this pixel
  float scale;  // of depth, scene units; of motion, 1 / the uv that is fully coloured; of radiance,
                // the exposure
  float unused;
};

ALCOVE_MATHS_END

#endif  // ALCOVE_SAMPLE_SHADERS_PICTURE_H_
