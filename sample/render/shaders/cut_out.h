// Declares the material of a draw for fragment shaders, and implements the alpha test.
#ifndef ALCOVE_SAMPLE_SHADERS_CUT_OUT_H_
#define ALCOVE_SAMPLE_SHADERS_CUT_OUT_H_

#include "gbuffer.h"

layout(set = 2, binding = 0) uniform sampler2D textures[kMaterialTextures];
layout(set = 2, binding = 1) uniform MaterialParameters { GbufferMaterial material; };

// Returns whether the alpha test discards a fragment. `vertex_alpha` is the alpha of the vertex
// colour.
bool is_cut_out(vec2 base_colour_uv, float vertex_alpha) {
  if (material.least_alpha <= 0.0) return false;
  float alpha = textureLod(textures[kMaskTexture], base_colour_uv, 0.0).a;
  return material.base_colour.a * vertex_alpha * alpha < material.least_alpha;
}

#endif  // ALCOVE_SAMPLE_SHADERS_CUT_OUT_H_
