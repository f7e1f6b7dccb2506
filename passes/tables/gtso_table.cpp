#include <algorithm>
#include <cmath>

#include "gtso_table.h"
#include "maths/ggx.h"
#include "maths/gtso_table.h"
#include "maths/packing.h"

namespace alcove::passes {

using maths::vec3;

GtsoLobe::GtsoLobe(float mirror_from_normal, float roughness, int samples)
    : mirror_from_normal_(mirror_from_normal) {
  const float alpha = std::max(roughness * roughness, maths::kSmallestAlpha);
  const float z = std::max(std::cos(mirror_from_normal), 1e-3f);
  const vec3 view(-std::sqrt(1.0f - z * z), 0.0f, z);
  double sum = 0.0;
  // Microfacet normals are sampled in proportion to the area of them that the view sees. The weight
  // is the fraction of the reflected light that other microfacets do not shadow.
  for (int i = 0; i < samples; ++i) {
    const double fraction = 0.5 + i * 0.6180339887498949;
    const vec3 half = maths::sample_ggx_normal(view, alpha, float(fraction - std::floor(fraction)),
                                               (float(i) + 0.5f) / float(samples));
    const vec3 light = 2.0f * glm::dot(view, half) * half - view;
    if (light.z <= 0.0f) continue;
    x_.push_back(light.x);
    y_.push_back(light.y);
    z_.push_back(light.z);
    weights_.push_back(maths::ggx_shadowing(view.z, light.z, alpha) /
                       maths::ggx_masking(view.z, alpha));
    sum += weights_.back();
  }
  for (float& weight : weights_) weight = static_cast<float>(weight / sum);
}

float GtsoLobe::within(float cone, const vec3& axis) const {
  // Chords, not cosines, are compared: near 0 a float has too few cosines for the narrowest lobe.
  const float chord = 2.0f * std::sin(0.5f * cone);
  float sum = 0.0f;
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    const float x = x_[i] - axis.x, y = y_[i] - axis.y, z = z_[i] - axis.z;
    sum += x * x + y * y + z * z <= chord * chord ? weights_[i] : 0.0f;
  }
  return std::min(sum, 1.0f);
}

float GtsoLobe::share(float cone, float bent_from_mirror, int sides) const {
  const float sine = std::sin(mirror_from_normal_);
  const float cosine = std::cos(mirror_from_normal_);
  const vec3 mirror(sine, 0.0f, cosine);
  const vec3 towards_normal(-cosine, 0.0f, sine);
  const vec3 across(0.0f, 1.0f, 0.0f);
  const float most = maths::gtso_sides(cone, bent_from_mirror, mirror_from_normal_);
  double sum = 0.0;
  for (int i = 0; i < sides; ++i) {
    const float side = most * (float(i) + 0.5f) / float(sides);
    sum += within(cone, std::cos(bent_from_mirror) * mirror +
                            std::sin(bent_from_mirror) *
                                (std::cos(side) * towards_normal + std::sin(side) * across));
  }
  return static_cast<float>(sum / sides);
}

std::vector<std::uint32_t> gtso_table() {
  constexpr int kSamples = 1024;
  constexpr int kSides = 8;
  std::vector<std::uint32_t> words(maths::kGtsoEntries / 4);
  const auto part = [](std::uint32_t i, std::uint32_t count) {
    return float(i) / float(count - 1);
  };
  for (std::uint32_t w = 0; w < maths::kGtsoRoughness; ++w) {
    const float roughness = part(w, maths::kGtsoRoughness);
    const float width = maths::gtso_width(roughness);
    for (std::uint32_t z = 0; z < maths::kGtsoMirror; ++z) {
      const GtsoLobe lobe(maths::unsqueeze_mirror(part(z, maths::kGtsoMirror)), roughness,
                          kSamples);
      for (std::uint32_t y = 0; y < maths::kGtsoCone; ++y) {
        const float cone = maths::unsqueeze_cone(part(y, maths::kGtsoCone), width);
        for (std::uint32_t x = 0; x < maths::kGtsoInside; ++x) {
          const float inside =
              maths::unsqueeze_inside(part(x, maths::kGtsoInside) * 2.0f - 1.0f, cone, width);
          const float share = lobe.share(cone, cone - inside, kSides);
          const std::uint32_t index = maths::gtso_index({x, y, z, w});
          words[index / 4] |= maths::pack_unorm(share, 8) << index % 4 * 8;
        }
      }
    }
  }
  return words;
}

float look_up_gtso(std::span<const std::uint32_t> table, float visibility, float cone,
                   float bent_from_mirror, float mirror_from_normal, float roughness) {
  const float exact = maths::gtso_exact(visibility, cone, bent_from_mirror, roughness);
  if (exact >= 0.0f) return exact;
  const maths::vec4 at =
      maths::gtso_coordinates(cone, bent_from_mirror, mirror_from_normal, roughness);
  const maths::uvec4 entry = maths::gtso_entry(at);
  const maths::vec4 t = at - maths::vec4(entry);
  float sum = 0.0f;
  for (std::uint32_t corner = 0; corner < 16; ++corner) {
    const std::uint32_t index = maths::gtso_index(maths::gtso_corner(entry, corner));
    sum += maths::gtso_corner_weight(t, corner) *
           maths::unpack_unorm(table[index / 4] >> index % 4 * 8, 8);
  }
  return sum;
}

}  // namespace alcove::passes
