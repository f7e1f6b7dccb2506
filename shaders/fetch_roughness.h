// The roughness of a pixel. A shader that includes this file defines kRoughnessTexture,
// kRoughnessChannel and roughness_image, and its parameters have the member `roughness`.
#ifndef ALCOVE_FETCH_ROUGHNESS_H
#define ALCOVE_FETCH_ROUGHNESS_H

#include "maths/language.h"

// Returns the perceptual roughness, [0,1]. `texel` is the pixel's position in the texture.
float fetch_roughness(ivec2 texel) {
  return kRoughnessTexture ? saturate(texelFetch(roughness_image, texel, 0)[kRoughnessChannel])
                           : parameters.roughness;
}

#endif
