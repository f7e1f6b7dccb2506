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

// Rows of GbufferMaterial::uv_rows: two for each lookup.
const uint kBaseColourUv = 0u;
const uint kMetallicRoughnessUv = 1u;
const uint kEmissiveUv = 2u;
const uint kNormalUv = 3u;
const uint kMaterialUvs = 4u;

// One for each material, in its descriptor set.
struct GbufferMaterial {
  vec4 base_colour;  // linear RGB, alpha
  vec4 emissive;     // linear RGB; w unused
  float metallic;
  float roughness;     // perceptual
  float alpha_cutoff;  // fragments of less alpha are discarded; 0 for opaque materials
  float normal_scale;  // multiplies the x and y of the normal map
  uint has_normal_map;
  uint unused_0;
  uint unused_1;
  uint unused_2;
  // Texture coordinates u and v of each lookup as dot(row.xyz, (mesh_uv, 1)); the first row's w is
  // the set of the mesh's coordinates, 0 or 1.
  vec4 uv_rows[8];
};

// Push constants of each draw.
struct GbufferDraw {
  uint moves;    // 1: placed by GbufferParameters::world_from_moving
  uint faceted;  // 1: without vertex normals
};

ALCOVE_MATHS_END

#endif  // ALCOVE_SAMPLE_SHADERS_GBUFFER_H_
