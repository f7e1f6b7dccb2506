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

// Once a draw, as push constants; texture indices count from 0, texture 0 is white.
struct GbufferDraw {
  vec4 base_colour;  // linear RGB, alpha
  vec4 emissive;     // linear RGB; w unused
  float metallic;
  float roughness;     // perceptual
  float alpha_cutoff;  // below it a fragment is dropped; 0 for opaque materials
  uint base_colour_texture;
  uint mask_texture;  // base colour as masks read it
  uint metallic_roughness_texture;
  uint emissive_texture;
  uint normal_texture;  // 0: none
  float normal_scale;   // of its x and y
  uint moves;  // 1: positions and normals are those of GbufferParameters::world_from_moving
};

ALCOVE_MATHS_END

#endif  // ALCOVE_SAMPLE_SHADERS_GBUFFER_H_
