#include <algorithm>
#include <cmath>

#include "maths/ggx.h"
#include "maths/packing.h"
#include "maths/split_sum.h"
#include "tables.h"

namespace alcove::passes {
namespace {

using maths::vec2;
using maths::vec3;

constexpr int kSamples = 2048;

// Over the microfacets that the view sees, spread evenly, each with what leaves unshadowed.
vec2 integrate(float n_dot_v, float roughness) {
  const float alpha = roughness * roughness;
  const float z = std::max(n_dot_v, 1e-4f);
  const vec3 view(std::sqrt(1.0f - z * z), 0.0f, z);
  double scale = 0.0;
  double offset = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double turn = 0.5 + i * 0.6180339887498949;
    const vec3 half = maths::sample_ggx_normal(view, alpha, float(turn - std::floor(turn)),
                                               (float(i) + 0.5f) / float(kSamples));
    const vec3 light = 2.0f * glm::dot(view, half) * half - view;
    if (light.z > 0.0f) {
      const double share = maths::ggx_shadowing(z, light.z, alpha) / maths::ggx_masking(z, alpha);
      const double fresnel = std::pow(1.0 - std::clamp(glm::dot(view, half), 0.0f, 1.0f), 5.0);
      scale += share * (1.0 - fresnel);
      offset += share * fresnel;
    }
  }
  return {float(scale / kSamples), float(offset / kSamples)};
}

}  // namespace

std::vector<std::uint32_t> reflectance_table() {
  std::vector<std::uint32_t> words;
  for (std::uint32_t y = 0; y < maths::kReflectanceTable; ++y) {
    for (std::uint32_t x = 0; x < maths::kReflectanceTable; ++x) {
      const vec2 entry = maths::reflectance_entry(x, y);
      const vec2 value = integrate(entry.x, entry.y);
      words.push_back(maths::pack_unorm(value.x, 16) | maths::pack_unorm(value.y, 16) << 16);
    }
  }
  return words;
}

}  // namespace alcove::passes
