// Declarations that the shader of the light pass shares with C++.
#ifndef ALCOVE_SAMPLE_SHADERS_LIGHT_H_
#define ALCOVE_SAMPLE_SHADERS_LIGHT_H_

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

// The images in the descriptor set, by index. The occlusion is read only if `uses` has its bits.
const uint kLightEnvironment = 0u;  // an EnvironmentImage
const uint kLightDepth = 1u;        // as the projection wrote it
const uint kLightNormal = 2u;       // xyz
const uint kLightAlbedo = 3u;       // linear RGB, alpha roughness
const uint kLightEmissive = 4u;     // alpha metallic
const uint kLightVisibility = 5u;
const uint kLightBentNormal = 6u;
const uint kLightSpecular = 7u;  // specular occlusion
const uint kLightImages = 8u;

// Bits of LightParameters::uses.
const uint kUsesVisibility = 1u;
const uint kUsesBentNormal = 2u;
const uint kUsesSpecular = 4u;
const uint kUsesMultiBounce = 8u;

struct LightParameters {
  mat3x4 world_from_ndc;     // converts (ndc x, ndc y, 1) to the direction of the pixel's view ray
  mat3x4 world_from_normal;  // rotation from the space of the normals to world space
  float sky_depth;           // the depth of pixels without a surface
  float roughness;           // perceptual, of every surface; negative: the materials' own
  uint uses;
};

ALCOVE_MATHS_END

#endif  // ALCOVE_SAMPLE_SHADERS_LIGHT_H_
