#version 450

layout(push_constant) uniform Camera { mat4 clip_from_world; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec3 out_normal;

void main() {
  gl_Position = clip_from_world * vec4(position, 1.0);
  out_normal = normal;
}
