// Surfaces under a probe, and the light that goes from them to the eye: by the formulas of the
// shaders, on the host.
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
  static constexpr float kSky = 1e12f;  // the depth where there is no surface

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

// They face the eye, in view space, with every seventh pixel sky.
LitSurfaces random_surfaces();

// Puts them under white light from everywhere.
void make_white(LitSurfaces& surfaces);

struct Light {
  maths::vec3 diffuse{0};
  maths::vec3 specular{0};
};

// What add_apply should write at a pixel, all inputs given, normals in view space.
Light reference_light(const LitSurfaces& surfaces, const View& view, std::uint32_t x,
                      std::uint32_t y);

}  // namespace alcove::passes
