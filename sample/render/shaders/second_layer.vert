#version 460
#extension GL_GOOGLE_include_directive : require

// As gbuffer.vert, but for depth alone.

#include "gbuffer.h"

layout(set = 0, binding = 0) uniform Parameters { GbufferParameters parameters; };
layout(push_constant) uniform Draw { GbufferDraw draw; };

layout(location = 0) in vec3 position;
layout(location = 4) in vec4 surface_uv;

layout(location = 0) out vec2 out_base_colour_uv;

void main() {
  vec4 position_ws = vec4(position, 1.0);
  if (draw.moves != 0u) {
    position_ws = parameters.world_from_moving * position_ws;
  }
  gl_Position = parameters.clip_from_world * position_ws;
  out_base_colour_uv = surface_uv.xy;
}
