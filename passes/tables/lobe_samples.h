// The GGX lobe by samples, for the integrals of the tables.
#pragma once

#include <cmath>

#include "maths/ggx.h"

namespace alcove::passes {

// Calls f(light, half vector, share) for microfacets spread evenly over those that `view` sees,
// where they reflect it to a light above the surface. `share` of that light leaves unshadowed.
// Tangent space, z along the normal; view.z above 0.
template <typename Function>
void for_each_lobe_sample(const maths::vec3& view, float alpha, int samples, Function&& f) {
  for (int i = 0; i < samples; ++i) {
    const double turn = 0.5 + i * 0.6180339887498949;
    const maths::vec3 half = maths::sample_ggx_normal(view, alpha, float(turn - std::floor(turn)),
                                                      (float(i) + 0.5f) / float(samples));
    const maths::vec3 light = 2.0f * glm::dot(view, half) * half - view;
    if (light.z > 0.0f) {
      f(light, half,
        maths::ggx_shadowing(view.z, light.z, alpha) / maths::ggx_masking(view.z, alpha));
    }
  }
}

}  // namespace alcove::passes
