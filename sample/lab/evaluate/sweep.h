// Settings with different numbers of samples: the points of a trade between error and time.
#pragma once

#include <string>
#include <vector>

#include "gpu/occlusion.h"

namespace alcove::sample {

struct Variant {
  std::string name;
  OcclusionSettings settings;
};

// Returns `settings` with the tile size, slices, steps and resolution of `samples`.
[[nodiscard]] OcclusionSettings with_samples(OcclusionSettings settings,
                                             const OcclusionSettings& samples);

// Returns the presets, and other settings with tile sizes, numbers of slices and steps, and half
// resolution between and beyond those of the presets. Everything else is as in `base`, except that
// a preset with a second depth layer has one. No setting appears twice. `base` itself appears only
// if it equals one of these.
[[nodiscard]] std::vector<Variant> preset_sweep(const OcclusionSettings& base);

}  // namespace alcove::sample
