// Declarations that the vertex shader, the fragment shader and the C++ code of the g-buffer share.
#ifndef ALCOVE_SAMPLE_SHADERS_GBUFFER_H_
#define ALCOVE_SAMPLE_SHADERS_GBUFFER_H_

#include "maths/language.h"

ALCOVE_MATHS_BEGIN

// Parameters that are the same for all draws of a frame.
struct GbufferParameters {
  mat4 clip_from_world;
  // The matrix from world to clip space of the previous frame, but with the jitter of this frame,
  // so that motion vectors contain only the motion of surfaces.
  mat4 previous_clip_from_world;
  mat4 world_from_moving;  // placement of draws that move; rotation and translation
  mat4 previous_world_from_moving;
  // Linear depth is (x * depth_ndc + y) / (z * depth_ndc + w), as Projection has it.
  vec4 depth_unproject;
  vec4 eye_ws;  // w = 1: a position; w = 0: the direction towards the eye
};

// The indices of a material's textures in its descriptor set. A missing texture is white.
const uint kBaseColourTexture = 0u;
const uint kMaskTexture = 1u;  // the base colour as the alpha test reads it
const uint kMetallicRoughnessTexture = 2u;
const uint kEmissiveTexture = 3u;
const uint kNormalTexture = 4u;
const uint kMaterialTextures = 5u;

// Indices of the texture lookups. Each has two rows in GbufferMaterial::uv_rows.
const uint kBaseColourUv = 0u;
const uint kMetallicRoughnessUv = 1u;
const uint kEmissiveUv = 2u;
const uint kNormalUv = 3u;

// Parameters of a material, in its descriptor set.
struct GbufferMaterial {
  vec4 base_colour;  // linear RGB, alpha
  vec4 emissive;     // linear RGB; w unused
  float metallic;
  float roughness;     // perceptual
  float least_alpha;   // fragments with less alpha are discarded; 0 for opaque materials
  float normal_scale;  // multiplies the x and y of the normal map
  uint has_normal_map;
  uint unused_0;
  uint unused_1;
  uint unused_2;
  // The rows of the transforms of texture coordinates, two for each lookup: u is dot(row.xyz,
  // (mesh_uv, 1)) with the first row, and v with the second. The w of the first row is the index of
  // the mesh's set of coordinates, 0 or 1.
  vec4 uv_rows[8];
};

// Push constants of each draw.
struct GbufferDraw {
  uint moves;    // 1: the draw is placed by GbufferParameters::world_from_moving
  uint faceted;  // 1: the mesh has no vertex normals
};

ALCOVE_MATHS_END

#endif  // ALCOVE_SAMPLE_SHADERS_GBUFFER_H_
