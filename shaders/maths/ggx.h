// The GGX microfacet lobe, by which directions count in specular occlusion. The ray-traced truth
// has code of its own (sample/lab/reference/sampling.h), so that an error here shows against it.
//
// Directions are in tangent space with z along the normal. `view` and `light` are unit and point
// away from the surface. `alpha` is the GGX width, perceptual roughness squared, in [0,1]. Values
// below kSmallestAlpha are replaced by it; such a lobe is a mirror in float precision.
#ifndef ALCOVE_MATHS_GGX_H
#define ALCOVE_MATHS_GGX_H

#include "constants.h"
#include "language.h"

ALCOVE_MATHS_BEGIN

const float kSmallestAlpha = 1e-3f;

// Returns the density of microfacet normals per steradian (Walter et al. 2007, eq. 33). `n_dot_h`,
// in [0,1], is the cosine between a microfacet normal and the surface normal.
ALCOVE_INLINE float ggx_distribution(float n_dot_h, float alpha) {
  float a = max(alpha, kSmallestAlpha);
  float a2 = a * a;
  // (n.h)^2 (a^2 - 1) + 1, in a form that does not cancel at small alpha near n.h = 1.
  float c2 = n_dot_h * n_dot_h;
  float d = max(1.0f - c2, 0.0f) + c2 * a2;
  return a2 / (kPi * d * d);
}

// Returns Smith's function Lambda of GGX for a direction whose angle to the normal has the cosine
// `n_dot_x` (Heitz 2014, eq. 72).
ALCOVE_INLINE float ggx_lambda(float n_dot_x, float alpha) {
  float a = max(alpha, kSmallestAlpha);
  float c2 = max(n_dot_x * n_dot_x, 1e-12f);
  return 0.5f * (sqrt(1.0f + a * a * max(1.0f - c2, 0.0f) / c2) - 1.0f);
}

// Returns the fraction of microfacets, [0,1], that are visible from one direction.
ALCOVE_INLINE float ggx_masking(float n_dot_x, float alpha) {
  return 1.0f / (1.0f + ggx_lambda(n_dot_x, alpha));
}

// Returns the fraction of microfacets, [0,1], that are visible from both directions, with
// height-correlated masking and shadowing.
ALCOVE_INLINE float ggx_shadowing(float n_dot_v, float n_dot_l, float alpha) {
  return 1.0f / (1.0f + ggx_lambda(n_dot_v, alpha) + ggx_lambda(n_dot_l, alpha));
}

// Samples a microfacet normal from two uniform numbers in [0,1), with a probability proportional to
// the area of microfacets with that normal that is visible from `view` (Dupuy and Benyoub 2023).
// `view.z` must be at least 0.
ALCOVE_INLINE vec3 sample_ggx_normal(vec3 view, float alpha, float u1, float u2) {
  float a = max(alpha, kSmallestAlpha);
  vec3 stretched = normalize(vec3(view.x * a, view.y * a, view.z));
  float phi = 2.0f * kPi * u1;
  float z = (1.0f - u2) * (1.0f + stretched.z) - stretched.z;
  float radius = sqrt(clamp(1.0f - z * z, 0.0f, 1.0f));
  vec3 cap = vec3(radius * cos(phi), radius * sin(phi), z) + stretched;
  return normalize(vec3(cap.x * a, cap.y * a, max(cap.z, 1e-7f)));
}

// Returns the probability density per steradian of the light direction that is obtained by
// reflecting `view` at a normal of sample_ggx_normal(). The lobe (BRDF times the cosine of the
// light, without Fresnel) divided by this density is ggx_shadowing() / ggx_masking(), which is in
// [0,1].
ALCOVE_INLINE float ggx_reflection_density(vec3 normal, vec3 view, vec3 light, float alpha) {
  float n_dot_v = max(dot(normal, view), 1e-6f);
  float n_dot_h = clamp(dot(normal, normalize(view + light)), 0.0f, 1.0f);
  return ggx_distribution(n_dot_h, alpha) * ggx_masking(n_dot_v, alpha) / (4.0f * n_dot_v);
}

ALCOVE_MATHS_END

#endif
