#version 460
#extension GL_GOOGLE_include_directive : require

#include "gbuffer.h"

layout(set = 0, binding = 0) uniform Parameters { GbufferParameters parameters; };
layout(push_constant) uniform Draw { GbufferDraw draw; };

// In world space, or in that of what moves.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 face_normal;
layout(location = 3) in vec4 tangent;
layout(location = 4) in vec4 surface_uv;
layout(location = 5) in vec4 detail_uv;

layout(location = 0) out vec3 out_position_ws;
layout(location = 1) out vec3 out_normal_ws;
layout(location = 2) flat out vec3 out_face_normal_ws;
layout(location = 3) out vec4 out_tangent_ws;
layout(location = 4) out vec4 out_surface_uv;
layout(location = 5) out vec4 out_detail_uv;
layout(location = 6) out vec4 out_clip;
layout(location = 7) out vec4 out_previous_clip;

void main() {
  vec4 position_ws = vec4(position, 1.0);
  vec4 previous_ws = position_ws;
  out_normal_ws = normal;
  out_face_normal_ws = face_normal;
  out_tangent_ws = tangent;
  if (draw.moves != 0u) {
    position_ws = parameters.world_from_moving * position_ws;
    previous_ws = parameters.previous_world_from_moving * previous_ws;
    out_normal_ws = mat3(parameters.world_from_moving) * normal;
    out_face_normal_ws = mat3(parameters.world_from_moving) * face_normal;
    out_tangent_ws.xyz = mat3(parameters.world_from_moving) * tangent.xyz;
  }
  gl_Position = parameters.clip_from_world * position_ws;
  out_position_ws = position_ws.xyz;
  out_surface_uv = surface_uv;
  out_detail_uv = detail_uv;
  out_clip = gl_Position;
  out_previous_clip = parameters.previous_clip_from_world * previous_ws;
}
