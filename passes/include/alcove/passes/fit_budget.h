// A controller that fits the number of samples to a time.
#pragma once

#include <cstdint>
#include <span>

#include "alcove/passes/settings.h"

namespace alcove::passes {

// A target and the limits between which fit_budget() may choose.
struct Budget {
  double target_ms = 1.0;  // of the occlusion passes of a view; above 0
  std::uint32_t least_slices = 1;
  std::uint32_t most_slices = 2;
  std::uint32_t least_steps = 6;
  std::uint32_t most_steps = 12;
};

// Returns the settings with other `slices` and `steps`, so that the passes take about, and if the
// limits allow it at most, the target. `milliseconds` are the measured times of the last frames
// that were drawn with these settings, the newest last: after a change the caller starts anew.
// alcoveFitBudget (alcove_settings.h) describes the rule. It does not change other settings,
// because a change of half_resolution or of the radius would be visible.
//
// Errors: a target that is not finite or not above 0, or limits that are out of range or exclude
// each other.
[[nodiscard]] tl::expected<OcclusionSettings, Error> fit_budget(
    const Budget& budget, std::span<const double> milliseconds, const OcclusionSettings& settings);

}  // namespace alcove::passes
