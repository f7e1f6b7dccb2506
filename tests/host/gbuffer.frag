#version 450

layout(location = 0) in vec3 normal;
layout(location = 0) out vec4 packed_normal;  // world space, A2B10G10R10_UNORM

void main() { packed_normal = vec4(0.5 + 0.5 * normal, 0.0); }
