// Error against time over many settings: the sweep, and its Pareto front.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "alcove/passes/occlusion.h"
#include "evaluate/truths.h"
#include "evaluate/variant.h"
#include "gpu_cost/gpu_part.h"
#include "render/session.h"
#include "support/result.h"

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
[[nodiscard]] Trade find_pareto_front(std::vector<Measurement> points);

// Combines the points of the same settings in several scenes: the mean of times and spreads, the
// root mean square of the RMSEs, and the largest number of bytes. There must be at least one list.
// All lists must have one length and one order of settings.
[[nodiscard]] std::vector<Measurement> over_scenes(
    std::span<const std::vector<Measurement>> scenes);

// The points of a trade.
struct MeasuredTrade {
  std::vector<Measurement> points;
  std::string clock_title;  // for headings, such as "modelled time on ..."
  std::string note;         // a line about settings that were left out; empty: none were
};

// Renders the session's view with every variant of preset_sweep() and compares each with the
// truths. choose_clock() says by which clock; modelled times are those of `part` at the size of the
// view. Leaves out half resolution if the device cannot store its format. Errors: `clock` is
// `modelled` and the driver is not installed, or a rendering fails.
[[nodiscard]] Result<MeasuredTrade> measure_trade(const Session& session, const StaticSetup& setup,
                                                  const TruthOptions& truth_options,
                                                  const GpuPart& part, std::optional<Clock> clock);

// The errors of sampling_grid() against scene truth, in its order. Nothing is timed.
[[nodiscard]] Result<std::vector<double>> measure_grid(const Session& session,
                                                       const StaticSetup& setup,
                                                       const TruthOptions& truth_options);
[[nodiscard]] std::string grid_table(const std::vector<double>& rmse);

// A line for each point; points on the Pareto front are marked.
[[nodiscard]] std::string format_table(const Trade& trade, const std::string& clock_title);

[[nodiscard]] nlohmann::ordered_json to_json(const Trade& trade);

}  // namespace alcove::sample
