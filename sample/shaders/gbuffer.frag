#version 460
#extension GL_GOOGLE_include_directive : require

#include "gbuffer.h"

layout(constant_id = 0) const uint kTextureCount = 1;
layout(constant_id = 1) const bool kGeometricNormals = false;

layout(set = 0, binding = 0) uniform Parameters { GbufferParameters parameters; };
layout(set = 0, binding = 1) uniform sampler2D textures[kTextureCount];
layout(push_constant) uniform Draw { GbufferDraw draw; };

layout(location = 0) in vec3 position_ws;
layout(location = 1) in vec3 normal_ws;
layout(location = 2) flat in vec3 face_normal_ws;
layout(location = 3) in vec2 uv;
layout(location = 4) in vec4 clip;
layout(location = 5) in vec4 previous_clip;

layout(location = 0) out vec4 out_normal_ws;  // unit, towards the eye
layout(location = 1) out vec4 out_albedo;     // linear RGB; alpha: perceptual roughness
layout(location = 2) out vec2 out_motion_uv;  // where this surface is, minus where it was
layout(location = 3) out vec4 out_emissive;   // linear RGB; alpha: metallic

// Both faces of a triangle are seen, so normals are turned to the side that is.
vec3 facing_normal() {
  vec3 to_eye = parameters.eye_ws.xyz - position_ws * parameters.eye_ws.w;
  vec3 face = dot(face_normal_ws, to_eye) < 0.0 ? -face_normal_ws : face_normal_ws;
  if (kGeometricNormals) {
    return face;
  }
  float squared = dot(normal_ws, normal_ws);
  vec3 shading = squared > 1e-12 ? normal_ws * inversesqrt(squared) : face;
  return dot(shading, face) < 0.0 ? -shading : shading;
}

void main() {
  vec4 base = draw.base_colour * texture(textures[draw.base_colour_texture], uv);
  if (base.a < draw.alpha_cutoff) {
    discard;
  }
  // glTF: roughness in green, metal in blue.
  vec4 surface = texture(textures[draw.metallic_roughness_texture], uv);
  out_normal_ws = vec4(facing_normal(), 0.0);
  out_albedo = vec4(base.rgb, draw.roughness * surface.g);
  out_motion_uv = 0.5 * (clip.xy / clip.w - previous_clip.xy / previous_clip.w);
  vec3 emissive = draw.emissive.rgb * texture(textures[draw.emissive_texture], uv).rgb;
  out_emissive = vec4(emissive, draw.metallic * surface.b);
}
