// Samples of the GGX lobe, for the integrals of the tables.
#pragma once

#include <cmath>

#include "maths/ggx.h"

namespace alcove::passes {

// Samples the GGX lobe of a surface seen from `view`. Microfacet normals are sampled in proportion
// to their visible area. If a normal reflects the view to a light direction above the surface,
// calls f(light, half vector, share). `share` is the fraction, [0,1], of the light that other
// microfacets do not shadow. Vectors are in tangent space with z along the normal; view.z must be
// above 0.
template <typename Function>
void for_each_lobe_sample(const maths::vec3& view, float alpha, int samples, Function&& f) {
  for (int i = 0; i < samples; ++i) {
    const double fraction = 0.5 + i * 0.6180339887498949;
    const maths::vec3 half = maths::sample_ggx_normal(
        view, alpha, float(fraction - std::floor(fraction)), (float(i) + 0.5f) / float(samples));
    const maths::vec3 light = 2.0f * glm::dot(view, half) * half - view;
    if (light.z > 0.0f) {
      f(light, half,
        maths::ggx_shadowing(view.z, light.z, alpha) / maths::ggx_masking(view.z, alpha));
    }
  }
}

}  // namespace alcove::passes
