#version 450

layout(set = 0, binding = 0) uniform sampler2D packed_normals;
layout(set = 0, binding = 1) uniform sampler2D visibility;
layout(location = 0) out vec4 colour;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 normal = normalize(2.0 * texelFetch(packed_normals, pixel, 0).xyz - 1.0);
  float sun = max(dot(normal, normalize(vec3(0.4, 0.8, 0.5))), 0.0);
  float ambient = 0.5 + 0.25 * normal.y;
  ambient *= texelFetch(visibility, pixel, 0).r;
  colour = vec4(vec3(0.6 * sun + 0.4 * ambient), 1.0);
}
