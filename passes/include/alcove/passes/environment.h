// Converts an equirectangular environment image to the probe that add_apply() takes.
#pragma once

#include <cstdint>

#include "alcove/passes/frame.h"

namespace alcove::passes {

struct EnvironmentSettings {
  std::uint32_t size = 256;    // width of the map's mip 0 in texels: a power of two, 16 to 2048
  std::uint32_t levels = 6;    // mips of the map, for roughness 0 to 1: 2 to log2(size) - 1
  std::uint32_t samples = 64;  // of a texel's lobe in the second level, 1 to 4096; more in the next
};

// The two textures of a probe. They are transients of the frame: to keep them for later frames,
// copy them to textures of your own.
struct Environment {
  framegraph::Texture harmonics;  // 9x1 RGBA32_SFLOAT: ApplyInputs::harmonics
  framegraph::Texture map;        // RGBA16_SFLOAT with mips: ApplyInputs::map
};

// Adds the passes that make a probe from `equirectangular`, an image of linear RGB radiance in any
// size and float format, in world space with +Y up (shaders/maths/environment_map.h). NaN and
// negative values count as black, and values above 65504 (the largest half float) as 65504. Passes
// whose result nobody reads are culled.
//
// Errors: a missing texture, or a setting out of range.
[[nodiscard]] tl::expected<Environment, Error> add_environment(
    const Frame& frame, framegraph::Texture equirectangular,
    const EnvironmentSettings& settings = {});

}  // namespace alcove::passes
