// The tables that the passes look up, by integrals: run in the build, and by the tests.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "maths/language.h"

namespace alcove::passes {

// The pairs of maths/split_sum.h by view, which varies fastest, and roughness. Each word holds two
// 16-bit unorms, the factor of f0 in the lower half.
[[nodiscard]] std::vector<std::uint32_t> reflectance_table();

// A GGX lobe above its surface, by samples spread evenly over the microfacets that its view sees.
class GtsoLobe {
 public:
  // `mirror_from_normal` in radians, [0,pi/2]; `roughness` perceptual.
  GtsoLobe(float mirror_from_normal, float roughness, int samples);

  // The share of the lobe within a cone whose axis lies `bent_from_mirror` from the mirror
  // direction, by maths/gtso_table.h: the mean over `sides` of its sides.
  [[nodiscard]] float share(float cone, float bent_from_mirror, int sides) const;
  // The same for one axis; the surface's normal is +Z, the mirror direction towards +X.
  [[nodiscard]] float within(float cone, const maths::vec3& axis) const;

 private:
  float mirror_from_normal_;
  std::vector<float> x_, y_, z_, weights_;
};

// maths/gtso_table.h's shares, four 8-bit parts of 1 a word, the lowest first.
[[nodiscard]] std::vector<std::uint32_t> gtso_table();

// The share of such a table at angles as maths/gtso_table.h has them, as the shader looks it up.
[[nodiscard]] float look_up_gtso(std::span<const std::uint32_t> table, float visibility, float cone,
                                 float bent_from_mirror, float mirror_from_normal, float roughness);

}  // namespace alcove::passes
