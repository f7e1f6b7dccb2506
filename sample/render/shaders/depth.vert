#version 460
#extension GL_GOOGLE_include_directive : require

// Transforms vertices exactly as gbuffer.vert does, for passes that write only depth.

#include "gbuffer_vertex.h"

layout(location = 0) out vec2 out_base_colour_uv;
layout(location = 1) out float out_alpha;  // alpha of the vertex colour

void main() {
  vec4 position_ws = vec4(world_from_mesh() * vec4(position, 1.0), 1.0);
  if (draw.moves != 0u) position_ws = parameters.world_from_moving * position_ws;
  gl_Position = parameters.clip_from_world * position_ws;
  out_base_colour_uv = lookup_uv(kBaseColourUv);
  out_alpha = color.a;
}
