#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluate/trade.h"
#include "evaluate/truths.h"
#include "evaluate/variant.h"
#include "gpu_cost/gpu_part.h"
#include "render/session.h"
#include "support/result.h"

namespace alcove::sample {

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
[[nodiscard]] std::string table_of(const Trade& trade, const std::string& clock_title);

[[nodiscard]] nlohmann::ordered_json to_json(const Trade& trade);

}  // namespace alcove::sample
