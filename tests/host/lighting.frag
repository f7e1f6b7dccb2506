#version 450

layout(constant_id = 0) const bool kPacked = true;  // normals are packed into [0,1]

layout(set = 0, binding = 0) uniform sampler2D normals;
layout(set = 0, binding = 1) uniform sampler2D visibility;
layout(location = 0) out vec4 colour;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 stored = texelFetch(normals, pixel, 0).xyz;
  vec3 normal = normalize(kPacked ? 2.0 * stored - 1.0 : stored);
  float sun = max(dot(normal, normalize(vec3(0.4, 0.8, 0.5))), 0.0);
  float ambient = 0.5 + 0.25 * normal.y;
  ambient *= texelFetch(visibility, pixel, 0).r;
  colour = vec4(vec3(0.6 * sun + 0.4 * ambient), 1.0);
}
