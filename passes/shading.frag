#version 460

// Applies the results of Alcove to ambient and image-based light in a lighting pass: a page to
// copy. All lookups are by pixel, because the results have the size of the g-buffer. Leave out the
// images that the view has no output for. Sun, lamps and emission are added afterwards, not
// multiplied.

layout(set = 0, binding = 0) uniform sampler2D visibility_image;    // ALCOVE_IMAGE_VISIBILITY
layout(set = 0, binding = 1) uniform sampler2D bent_normal_image;   // ALCOVE_IMAGE_BENT_NORMAL
layout(set = 0, binding = 2) uniform sampler2D specular_image;      // ALCOVE_IMAGE_SPECULAR
layout(set = 0, binding = 3) uniform sampler2D multi_bounce_image;  // ALCOVE_IMAGE_MULTI_BOUNCE
// Images of the engine: irradiance divided by pi, probe light by roughness, the table of the BRDF.
layout(set = 0, binding = 4) uniform samplerCube irradiance_map;
layout(set = 0, binding = 5) uniform samplerCube specular_map;
layout(set = 0, binding = 6) uniform sampler2D brdf_table;

// Light that comes from all sides. Directions are unit vectors in world space, `to_eye` too, and
// `roughness` is perceptual. If the g-buffer's normals are in view space, bent normals are too:
// rotate them by world_from_view first.
vec3 indirect_light(ivec2 pixel, vec3 normal, vec3 to_eye, vec3 albedo, vec3 f0, float roughness) {
  // Multi-bounce adds to visibility the light that occluders reflect, in their colour. Without it:
  // vec3 occlusion = vec3(texelFetch(visibility_image, pixel, 0).r);
  vec3 occlusion = texelFetch(multi_bounce_image, pixel, 0).rgb;
  // The bent normal is the mean direction that light comes from. Its length is not 1 after a
  // filter.
  vec3 bent_normal = normalize(texelFetch(bent_normal_image, pixel, 0).xyz);
  vec3 diffuse = albedo * occlusion * texture(irradiance_map, bent_normal).rgb;

  // Specular occlusion multiplies the probe's light alone. The reflection is about the normal.
  float n_dot_v = clamp(dot(normal, to_eye), 0.0, 1.0);
  float last_mip = float(textureQueryLevels(specular_map) - 1);
  vec3 probe = textureLod(specular_map, reflect(-to_eye, normal), roughness * last_mip).rgb;
  vec2 brdf = texture(brdf_table, vec2(n_dot_v, roughness)).rg;
  vec3 specular = probe * (f0 * brdf.x + brdf.y) * texelFetch(specular_image, pixel, 0).r;
  return diffuse + specular;
}

layout(location = 0) in vec3 normal;
layout(location = 1) in vec3 to_eye;
layout(location = 0) out vec4 light;

void main() {
  light = vec4(indirect_light(ivec2(gl_FragCoord.xy), normalize(normal), normalize(to_eye),
                              vec3(0.5), vec3(0.04), 0.5),
               1.0);
}
