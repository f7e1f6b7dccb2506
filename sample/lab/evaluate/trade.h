// Error against time over many settings: the sweep, and its Pareto front.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "alcove/passes/occlusion.h"
#include "evaluate/variant.h"

namespace alcove::sample {

// Returns the presets, and other settings with tile sizes, numbers of slices and steps, and half
// resolution between and beyond those of the presets. Everything else is as in `base`, except that
// a preset with a second depth layer has one. No setting appears twice. `base` itself appears only
// if it equals one of these.
[[nodiscard]] std::vector<Variant> preset_sweep(const passes::OcclusionSettings& base);

// Returns variants of `base` with 8, 16, 32 and 64 steps and 1, 2, 4 and 8 slices, ordered by
// steps. They show whether the error falls as samples are added.
inline constexpr std::array<std::uint32_t, 4> kGridSteps{8, 16, 32, 64};
inline constexpr std::array<std::uint32_t, 4> kGridSlices{1, 2, 4, 8};
[[nodiscard]] std::vector<Variant> sampling_grid(const passes::OcclusionSettings& base);

// Points in order of time. `on_pareto_front[i]` is true if every point with an error no larger than
// that of point i is slower by more than the spreads of both, because a smaller difference may be
// chance.
struct Trade {
  std::vector<Measurement> points;
  std::vector<bool> on_pareto_front;
};
[[nodiscard]] Trade trade_of(std::vector<Measurement> points);

// Combines the points of the same settings in several scenes: the mean of times and spreads, the
// root mean square of the RMSEs, and the largest number of bytes. There must be at least one list.
// All lists must have one length and one order of settings.
[[nodiscard]] std::vector<Measurement> over_scenes(
    std::span<const std::vector<Measurement>> scenes);

}  // namespace alcove::sample
