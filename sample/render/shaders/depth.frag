#version 460
#extension GL_GOOGLE_include_directive : require

#include "cut_out.h"

layout(location = 0) in vec2 base_colour_uv;
layout(location = 1) in float vertex_alpha;

void main() {
  if (is_cut_out(base_colour_uv, vertex_alpha)) discard;
}
