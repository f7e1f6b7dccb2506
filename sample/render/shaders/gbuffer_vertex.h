// Declares the vertex attributes of the scene's meshes, and transforms a vertex to world space.
#ifndef ALCOVE_SAMPLE_SHADERS_GBUFFER_VERTEX_H_
#define ALCOVE_SAMPLE_SHADERS_GBUFFER_VERTEX_H_

#include "gbuffer.h"

layout(set = 0, binding = 0) uniform Parameters { GbufferParameters parameters; };
layout(set = 2, binding = 1) uniform MaterialParameters { GbufferMaterial material; };
layout(push_constant) uniform Draw { GbufferDraw draw; };

// Attributes in mesh space. Locations 1 and 4 are normals and tangents, which only gbuffer.vert
// reads.
layout(location = 0) in vec3 position;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec2 second_uv;
layout(location = 5) in vec4 color;
// The 12 numbers of the instance's affine transform, column by column.
layout(location = 6) in vec4 instance_0;
layout(location = 7) in vec4 instance_1;
layout(location = 8) in vec4 instance_2;

mat4x3 world_from_mesh() {
  return mat4x3(instance_0.xyz, vec3(instance_0.w, instance_1.xy),
                vec3(instance_1.zw, instance_2.x), instance_2.yzw);
}

// Returns the texture coordinates of a lookup (kBaseColourUv and so on). They are zero if they are
// not finite, which very large numbers can cause.
vec2 lookup_uv(uint lookup) {
  vec4 u = material.uv_rows[2u * lookup];
  vec4 v = material.uv_rows[2u * lookup + 1u];
  vec3 mesh_uv = vec3(u.w != 0.0 ? second_uv : uv, 1.0);
  vec2 found = vec2(dot(u.xyz, mesh_uv), dot(v.xyz, mesh_uv));
  return any(isnan(found)) || any(isinf(found)) ? vec2(0.0) : found;
}

#endif  // ALCOVE_SAMPLE_SHADERS_GBUFFER_VERTEX_H_
