// Reflected probe light by the split sum (Karis 2013): the lobe's light, prefiltered, times what
// the surface reflects of a white environment, which is linear in its reflectance at normal
// incidence: x * f0 + y by Schlick's Fresnel, with (x, y) from a table over view and roughness.
//
// The diffuse part gets what the specular leaves, 1 - (x * f0 + y), so that no more goes out than
// came in: a white dielectric in a white environment is white. Light that bounces between
// microfacets is lost: a white rough metal is grey.
#ifndef ALCOVE_MATHS_SPLIT_SUM_H
#define ALCOVE_MATHS_SPLIT_SUM_H

#include "language.h"

ALCOVE_MATHS_BEGIN

// Entries of the table on a side: by the root of the cosine of the view, and by roughness.
const uint kReflectanceTable = 32u;
const float kDielectricReflectance = 0.04f;

// Where a view and a perceptual roughness lie among the entries, [0, kReflectanceTable - 1]. The
// root spreads the grazing angles, where the table bends most.
ALCOVE_INLINE vec2 reflectance_coordinates(float n_dot_v, float roughness) {
  float last = float(kReflectanceTable - 1u);
  return vec2(sqrt(clamp(n_dot_v, 0.0f, 1.0f)) * last, clamp(roughness, 0.0f, 1.0f) * last);
}

// The view and the roughness that an entry is for.
ALCOVE_INLINE vec2 reflectance_entry(uint x, uint y) {
  float last = float(kReflectanceTable - 1u);
  float root = float(x) / last;
  return vec2(root * root, float(y) / last);
}

// The specular reflectance under uniform white light, per channel.
ALCOVE_INLINE vec3 specular_reflectance(vec3 f0, vec2 table_value) {
  return vec3(min(f0.x * table_value.x + table_value.y, 1.0f),
              min(f0.y * table_value.x + table_value.y, 1.0f),
              min(f0.z * table_value.x + table_value.y, 1.0f));
}

// Where a lobe's light is looked up: rough lobes stereographic from the mirror direction to the
// normal, as the surface cuts off what is under it (Lagarde and de Rousiers 2014). It halves the
// split sum's error from roughness 0.5 on.
ALCOVE_INLINE vec3 dominant_direction(vec3 normal, vec3 mirror, float roughness) {
  float alpha = clamp(roughness * roughness, 0.0f, 1.0f);
  float smooth_part = 1.0f - alpha;
  float weight = smooth_part * (sqrt(smooth_part) + alpha);
  return normalize(normal * (1.0f - weight) + mirror * weight);
}

// Metal and roughness after glTF 2.0: reflectance at normal incidence of a base colour.
ALCOVE_INLINE vec3 normal_reflectance(vec3 base_colour, float metallic) {
  float m = clamp(metallic, 0.0f, 1.0f);
  return base_colour * m + vec3(kDielectricReflectance * (1.0f - m));
}

// The part of the base colour that scatters diffusely, before the specular part takes its share.
ALCOVE_INLINE vec3 diffuse_albedo(vec3 base_colour, float metallic) {
  return base_colour * (1.0f - clamp(metallic, 0.0f, 1.0f));
}

ALCOVE_MATHS_END

#endif
