// A probe of what is infinitely far: an equirectangular image as the light that add_apply takes.
#pragma once

#include <cstdint>

#include "alcove/passes/frame.h"

namespace alcove::passes {

struct EnvironmentSettings {
  std::uint32_t size = 256;    // texels a side of the map's first level: a power of two, 16 to 2048
  std::uint32_t levels = 6;    // of the map, from roughness 0 to 1; 2 to log2(size) - 1
  std::uint32_t samples = 64;  // of a texel's lobe in the second level, 1 to 4096; more in the next
};

// Transients of the frame. An engine keeps them by copying them, for as long as its sky stays.
struct Environment {
  framegraph::Texture harmonics;  // 9x1 RGBA32_SFLOAT: ApplyInputs::harmonics
  framegraph::Texture map;        // RGBA16_SFLOAT with mips: ApplyInputs::map
};

// In: `equirectangular`, linear RGB radiance of any size and float format, world space with +Y up
// (shaders/maths/environment_map.h); what is not a number or below 0 counts as black, and what is
// over 65504 as that. What is not read of the result is culled.
//
// Errors: a texture that is missing, a setting out of range.
[[nodiscard]] tl::expected<Environment, Error> add_environment(
    const Frame& frame, framegraph::Texture equirectangular,
    const EnvironmentSettings& settings = {});

}  // namespace alcove::passes
