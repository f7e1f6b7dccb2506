#version 460
#extension GL_GOOGLE_include_directive : require

#include "gbuffer.h"

layout(set = 0, binding = 0) uniform Parameters { GbufferParameters parameters; };

layout(location = 0) in vec3 position_ws;
layout(location = 1) in vec3 normal_ws;
layout(location = 2) in vec3 face_normal_ws;
layout(location = 3) in vec2 uv;

layout(location = 0) out vec3 out_position_ws;
layout(location = 1) out vec3 out_normal_ws;
layout(location = 2) flat out vec3 out_face_normal_ws;
layout(location = 3) out vec2 out_uv;
layout(location = 4) out vec4 out_clip;
layout(location = 5) out vec4 out_previous_clip;

void main() {
  gl_Position = parameters.clip_from_world * vec4(position_ws, 1.0);
  out_position_ws = position_ws;
  out_normal_ws = normal_ws;
  out_face_normal_ws = face_normal_ws;
  out_uv = uv;
  out_clip = gl_Position;
  out_previous_clip = parameters.previous_clip_from_world * vec4(position_ws, 1.0);
}
