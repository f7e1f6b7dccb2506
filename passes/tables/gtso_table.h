// Computes the table of specular occlusion by numerical integration, for the build and the tests.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "maths/language.h"

namespace alcove::passes {

// A GGX lobe above its surface, represented by samples of the microfacets that its view sees.
class GtsoLobe {
 public:
  // Creates a lobe. `mirror_from_normal` is the angle between the mirror direction and the normal
  // in radians, [0,pi/2]. `roughness` is perceptual, [0,1]. `samples` is the number of samples of
  // the lobe.
  GtsoLobe(float mirror_from_normal, float roughness, int samples);

  // Returns the fraction of the lobe within a cone of half-angle `cone`, whose axis is
  // `bent_from_mirror` radians away from the mirror direction. It is the mean over `sides` azimuths
  // of the axis around the mirror direction.
  [[nodiscard]] float share(float cone, float bent_from_mirror, int sides) const;
  // Returns the fraction of the lobe within a cone around `axis`. The normal is +Z, and the mirror
  // direction is rotated from it towards +X.
  [[nodiscard]] float within(float cone, const maths::vec3& axis) const;

 private:
  float mirror_from_normal_;
  std::vector<float> x_, y_, z_, weights_;
};

// Returns the table of maths/gtso_table.h: fractions of lobes as 8-bit unorms, four per word with
// the first in the lowest byte.
[[nodiscard]] std::vector<std::uint32_t> gtso_table();

// Looks up the table at angles as maths/gtso_table.h defines them, with the shader's interpolation.
[[nodiscard]] float look_up_gtso(std::span<const std::uint32_t> table, float visibility, float cone,
                                 float bent_from_mirror, float mirror_from_normal, float roughness);

}  // namespace alcove::passes
