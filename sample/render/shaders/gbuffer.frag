#version 460
#extension GL_GOOGLE_include_directive : require

#include "cut_out.h"

layout(constant_id = 0) const bool kGeometricNormals = false;

layout(set = 0, binding = 0) uniform Parameters { GbufferParameters parameters; };

layout(location = 0) in vec3 position_ws;
layout(location = 1) in vec3 normal_ws;
layout(location = 2) flat in vec3 face_normal_ws;
layout(location = 3) in vec4 tangent_ws;  // w: the sign of the bitangent
layout(location = 4) in vec4 surface_uv;  // xy: base colour; zw: metal and roughness
layout(location = 5) in vec4 detail_uv;   // xy: emission; zw: normal map
layout(location = 6) in vec4 color;       // vertex colour, linear RGB and alpha
layout(location = 7) in vec4 clip;
layout(location = 8) in vec4 previous_clip;

layout(location = 0) out vec4 out_normal_ws;  // unit, towards the eye
layout(location = 1) out vec4 out_albedo;     // linear RGB; alpha: perceptual roughness
layout(location = 2) out vec2 out_motion_uv;  // uv minus uv in the previous frame
layout(location = 3) out vec4 out_emissive;   // linear RGB; alpha: metallic

// Returns the vertex normal perturbed by the normal map's `texel`, not normalised, or `normal`
// itself if there is no map or no tangent.
vec3 mapped_normal(vec3 normal, vec3 texel) {
  vec3 across = tangent_ws.xyz - normal * dot(normal, tangent_ws.xyz);
  float squared = dot(across, across);
  if (material.has_normal_map == 0u || !(squared > 1e-12)) return normal;
  vec3 tangent = across * inversesqrt(squared);
  vec3 bitangent = cross(normal, tangent) * (tangent_ws.w < 0.0 ? -1.0 : 1.0);
  vec2 slope = texel.xy * material.normal_scale;
  return tangent * slope.x + bitangent * slope.y + normal * texel.z;
}

// Returns the shading normal, flipped towards the eye if necessary, because both faces of a
// triangle may be visible.
vec3 facing_normal(vec3 texel) {
  vec3 to_eye = parameters.eye_ws.xyz - position_ws * parameters.eye_ws.w;
  vec3 face = dot(face_normal_ws, to_eye) < 0.0 ? -face_normal_ws : face_normal_ws;
  float squared = dot(normal_ws, normal_ws);
  if (kGeometricNormals || !(squared > 1e-12)) return face;
  vec3 normal = normal_ws * inversesqrt(squared);
  vec3 mapped = mapped_normal(normal, texel);
  // The whole tangent frame is flipped on a back face. If the normal map tilts the normal below the
  // triangle's own plane, the normal is moved back into that plane.
  vec3 shading = dot(normal, face) < 0.0 ? -mapped : mapped;
  shading -= face * min(dot(shading, face), 0.0);
  squared = dot(shading, shading);
  return squared > 1e-12 ? shading * inversesqrt(squared) : face;
}

void main() {
  // All texture lookups come before the first branch, because mip selection needs derivatives
  // between neighbouring invocations.
  vec3 base = texture(textures[kBaseColourTexture], surface_uv.xy).rgb;
  // glTF: roughness in green, metal in blue.
  vec2 surface = texture(textures[kMetallicRoughnessTexture], surface_uv.zw).gb;
  vec3 emissive = texture(textures[kEmissiveTexture], detail_uv.xy).rgb;
  vec3 mapped_normal = texture(textures[kNormalTexture], detail_uv.zw).xyz * 2.0 - 1.0;
  if (is_cut_out(surface_uv.xy, color.a)) discard;
  out_normal_ws = vec4(facing_normal(mapped_normal), 0.0);
  out_albedo = vec4(material.base_colour.rgb * color.rgb * base, material.roughness * surface.x);
  out_motion_uv = 0.5 * (clip.xy / clip.w - previous_clip.xy / previous_clip.w);
  out_emissive = vec4(material.emissive.rgb * emissive, material.metallic * surface.y);
}
