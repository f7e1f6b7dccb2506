#include <algorithm>
#include <cmath>

#include "lobe_samples.h"
#include "maths/packing.h"
#include "maths/split_sum.h"
#include "tables.h"

namespace alcove::passes {
namespace {

using maths::vec2;
using maths::vec3;

constexpr int kSamples = 2048;

// Returns the two factors x and y of shaders/maths/split_sum.h by numerical integration. The
// reflectance under uniform white light is x * f0 + y, where f0 is the reflectance at normal
// incidence.
vec2 integrate(float n_dot_v, float roughness) {
  const float alpha = roughness * roughness;
  const float z = std::max(n_dot_v, 1e-4f);
  const vec3 view(std::sqrt(1.0f - z * z), 0.0f, z);
  double scale = 0.0;
  double offset = 0.0;
  for_each_lobe_sample(view, alpha, kSamples, [&](const vec3&, const vec3& half, double share) {
    const double fresnel = std::pow(1.0 - std::clamp(glm::dot(view, half), 0.0f, 1.0f), 5.0);
    scale += share * (1.0 - fresnel);
    offset += share * fresnel;
  });
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
