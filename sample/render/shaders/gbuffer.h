// What the two stages of the g-buffer and the C++ that draws it share. Included by all three.
#ifndef ALCOVE_SAMPLE_SHADERS_GBUFFER_H_
#define ALCOVE_SAMPLE_SHADERS_GBUFFER_H_

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

// Once a frame.
struct GbufferParameters {
  mat4 clip_from_world;
  mat4 previous_clip_from_world;  // without jitter differences: motion is of surfaces alone
  mat4 world_from_moving;         // of draws that move; rotation and translation
  mat4 previous_world_from_moving;
  // Linear depth is (x * depth_ndc + y) / (z * depth_ndc + w), as Projection has it.
  vec4 depth_unproject;
  vec4 eye_ws;  // w = 1: a position; w = 0: the direction towards the eye
};

// The textures of a material, in the order of their set; white where it has none.
const uint kBaseColourTexture = 0u;
const uint kMaskTexture = 1u;  // base colour as masks read it
const uint kMetallicRoughnessTexture = 2u;
const uint kEmissiveTexture = 3u;
const uint kNormalTexture = 4u;
const uint kMaterialTextures = 5u;

// Once a draw, as push constants.
struct GbufferDraw {
  vec4 base_colour;  // linear RGB, alpha
  vec4 emissive;     // linear RGB; w unused
  float metallic;
  float roughness;     // perceptual
  float alpha_cutoff;  // below it a fragment is dropped; 0 for opaque materials
  float normal_scale;  // of the normal map's x and y
  uint has_normal_map;
  uint moves;  // 1: positions and normals are those of GbufferParameters::world_from_moving
};

ALCOVE_MATHS_END

#endif  // ALCOVE_SAMPLE_SHADERS_GBUFFER_H_
