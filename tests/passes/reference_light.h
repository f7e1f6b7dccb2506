// Surfaces lit by a probe. Their radiance towards the eye is computed on the CPU with the shaders'
// formulas.
#pragma once

#include <cstdint>

#include "maths/language.h"
#include "maths/spherical_harmonics.h"
#include "pass_fixture.h"

namespace alcove::passes {

struct LitSurfaces {
  static constexpr std::uint32_t kWidth = 37;
  static constexpr std::uint32_t kHeight = 23;
  static constexpr std::uint32_t kMapSize = 8;
  static constexpr float kSky = 1e12f;  // depth of the sky

  HostImage depth{kWidth, kHeight, {}, 1};
  HostImage normals{kWidth, kHeight, {}, 4};
  HostImage bent{kWidth, kHeight, {}, 4};
  HostImage albedo{kWidth, kHeight, {}, 4};  // roughness in the last channel
  HostImage light{kWidth, kHeight, {}, 4};   // metallic in the last channel
  HostImage visibility{kWidth, kHeight, {}, 1};
  HostImage specular_occlusion{kWidth, kHeight, {}, 1};
  HostImage harmonics{maths::kHarmonics, 1, {}, 4};
  HostImage map{kMapSize, kMapSize, {}, 4};
};

// Returns random surfaces that face the eye, with normals in view space. Every seventh pixel is
// sky.
LitSurfaces random_surfaces();

// Changes the probe to uniform white light.
void make_white(LitSurfaces& surfaces);

struct Light {
  maths::vec3 diffuse{0};
  maths::vec3 specular{0};
};

// Returns the light that add_apply() should write at a pixel if all inputs are given and normals
// are in view space.
Light reference_light(const LitSurfaces& surfaces, const View& view, std::uint32_t x,
                      std::uint32_t y);

}  // namespace alcove::passes
