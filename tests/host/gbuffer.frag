#version 450

layout(constant_id = 0) const bool kPacked = true;  // into [0,1]

layout(location = 0) in vec3 normal;
layout(location = 0) out vec4 stored_normal;  // world space

void main() { stored_normal = vec4(kPacked ? 0.5 + 0.5 * normal : normal, 0.0); }
