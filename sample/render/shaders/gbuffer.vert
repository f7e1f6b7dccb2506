#version 460
#extension GL_GOOGLE_include_directive : require

#include "gbuffer_vertex.h"
#include "maths/octahedral.h"

layout(location = 1) in vec4 packed_normals;  // octahedral; xy: vertex, zw: triangle
layout(location = 4) in vec4 packed_tangent;  // xy: octahedral; z: bitangent sign, 0: none

layout(location = 0) out vec3 out_position_ws;
layout(location = 1) out vec3 out_normal_ws;            // zero if the mesh has none
layout(location = 2) flat out vec3 out_face_normal_ws;  // of the triangle
layout(location = 3) out vec4 out_tangent_ws;           // w: the sign of the bitangent
layout(location = 4) out vec4 out_surface_uv;
layout(location = 5) out vec4 out_detail_uv;
layout(location = 6) out vec4 out_color;
layout(location = 7) out vec4 out_clip;
layout(location = 8) out vec4 out_previous_clip;

void main() {
  mat4x3 placed = world_from_mesh();
  mat3 linear = mat3(placed);
  // The cofactor matrix is the inverse transpose times the determinant. It also exists if the
  // determinant is 0.
  mat3 cofactor =
      mat3(cross(linear[1], linear[2]), cross(linear[2], linear[0]), cross(linear[0], linear[1]));
  float side = determinant(linear) < 0.0 ? -1.0 : 1.0;

  vec4 position_ws = vec4(placed * vec4(position, 1.0), 1.0);
  vec4 previous_ws = position_ws;
  vec3 normal = octahedral_decode(packed_normals.xy);
  out_normal_ws = draw.faceted != 0u ? vec3(0.0) : normalize(side * (cofactor * normal));
  out_face_normal_ws = normalize(side * (cofactor * octahedral_decode(packed_normals.zw)));
  vec3 tangent = packed_tangent.z == 0.0 ? vec3(0.0) : octahedral_decode(packed_tangent.xy);
  out_tangent_ws = vec4(linear * tangent, packed_tangent.z * side);
  if (draw.moves != 0u) {
    position_ws = parameters.world_from_moving * position_ws;
    previous_ws = parameters.previous_world_from_moving * previous_ws;
    out_normal_ws = mat3(parameters.world_from_moving) * out_normal_ws;
    out_face_normal_ws = mat3(parameters.world_from_moving) * out_face_normal_ws;
    out_tangent_ws.xyz = mat3(parameters.world_from_moving) * out_tangent_ws.xyz;
  }
  gl_Position = parameters.clip_from_world * position_ws;
  out_position_ws = position_ws.xyz;
  out_surface_uv = vec4(lookup_uv(kBaseColourUv), lookup_uv(kMetallicRoughnessUv));
  out_detail_uv = vec4(lookup_uv(kEmissiveUv), lookup_uv(kNormalUv));
  out_color = color;
  out_clip = gl_Position;
  out_previous_clip = parameters.previous_clip_from_world * previous_ws;
}
