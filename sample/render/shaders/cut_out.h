// The material's textures and the draw, as fragment shaders have them, and what a mask cuts out.
#ifndef ALCOVE_SAMPLE_SHADERS_CUT_OUT_H_
#define ALCOVE_SAMPLE_SHADERS_CUT_OUT_H_

#include "gbuffer.h"

layout(set = 2, binding = 0) uniform sampler2D textures[kMaterialTextures];
layout(push_constant) uniform Draw { GbufferDraw draw; };

bool is_cut_out(vec2 base_colour_uv) {
  if (draw.alpha_cutoff <= 0.0) {
    return false;
  }
  float alpha = textureLod(textures[kMaskTexture], base_colour_uv, 0.0).a;
  return draw.base_colour.a * alpha < draw.alpha_cutoff;
}

#endif  // ALCOVE_SAMPLE_SHADERS_CUT_OUT_H_
