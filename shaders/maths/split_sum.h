// Specular light from a probe by the split-sum approximation (Karis 2013): the prefiltered light of
// the lobe, times the reflectance of the surface under uniform white light. With Schlick's Fresnel
// term that reflectance is x * f0 + y, where f0 is the reflectance at normal incidence, and (x, y)
// come from a table over view angle and roughness.
//
// The diffuse part gets the remaining energy, 1 - (x * f0 + y), so that a white dielectric in a
// white environment is white. Light that bounces between microfacets is lost: a white, rough metal
// is grey.
#ifndef ALCOVE_MATHS_SPLIT_SUM_H
#define ALCOVE_MATHS_SPLIT_SUM_H

#include "language.h"

ALCOVE_MATHS_BEGIN

// Width and height of the table: one axis is the square root of N.V, the other the roughness.
const uint kReflectanceTable = 32u;
const float kDielectricReflectance = 0.04f;

// Returns the table coordinates, [0, kReflectanceTable - 1], of a view angle and a perceptual
// roughness. The square root gives more entries to grazing angles, where the table is most curved.
ALCOVE_INLINE vec2 reflectance_coordinates(float n_dot_v, float roughness) {
  float last = float(kReflectanceTable - 1u);
  return vec2(sqrt(clamp(n_dot_v, 0.0f, 1.0f)) * last, clamp(roughness, 0.0f, 1.0f) * last);
}

// Returns N.V and the roughness of a table entry.
ALCOVE_INLINE vec2 reflectance_entry(uint x, uint y) {
  float last = float(kReflectanceTable - 1u);
  float root = float(x) / last;
  return vec2(root * root, float(y) / last);
}

// Returns the specular reflectance under uniform white light, per channel.
ALCOVE_INLINE vec3 specular_reflectance(vec3 f0, vec2 table_value) {
  return vec3(min(f0.x * table_value.x + table_value.y, 1.0f),
              min(f0.y * table_value.x + table_value.y, 1.0f),
              min(f0.z * table_value.x + table_value.y, 1.0f));
}

// Returns the direction in which the light of a lobe is looked up. For rough lobes it moves from
// the mirror direction towards the normal, because the surface cuts off the part of the lobe below
// it (Lagarde and de Rousiers 2014). For roughness 0.5 and above it halves the error of the
// split-sum approximation.
ALCOVE_INLINE vec3 dominant_direction(vec3 normal, vec3 mirror, float roughness) {
  float alpha = clamp(roughness * roughness, 0.0f, 1.0f);
  float smooth_part = 1.0f - alpha;
  float weight = smooth_part * (sqrt(smooth_part) + alpha);
  return normalize(normal * (1.0f - weight) + mirror * weight);
}

// Returns the reflectance at normal incidence of a glTF 2.0 material.
ALCOVE_INLINE vec3 normal_reflectance(vec3 base_colour, float metallic) {
  float m = clamp(metallic, 0.0f, 1.0f);
  return base_colour * m + vec3(kDielectricReflectance * (1.0f - m));
}

// Returns the diffuse albedo of a glTF 2.0 material, before the specular part takes its energy.
ALCOVE_INLINE vec3 diffuse_albedo(vec3 base_colour, float metallic) {
  return base_colour * (1.0f - clamp(metallic, 0.0f, 1.0f));
}

ALCOVE_MATHS_END

#endif
