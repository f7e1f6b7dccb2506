#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "evaluate/trade.h"
#include "evaluate/truths.h"
#include "evaluate/variant.h"
#include "render/session.h"

namespace alcove::sample {

// The points of a trade, and what their times are.
struct MeasuredTrade {
  std::vector<TradePoint> points;
  Clock clock = Clock::processor;
  std::string clock_title;  // for headings: "modelled time on ...", say
};

// Draws the session's view in every way of preset_sweep() and compares each with the truths. The
// clock is the timestamps of a GPU. A software device's timestamps are noise: in their place stands
// the modelled time of an RDNA2 part, or processor time where Mesa's AMD driver is not installed.
[[nodiscard]] tl::expected<MeasuredTrade, std::string> measure_trade(
    const Session& session, const StaticSetup& setup, const TruthOptions& truth_options);

// The errors of sampling_grid() against scene truth, in its order. Nothing is timed.
[[nodiscard]] tl::expected<std::vector<double>, std::string> measure_grid(
    const Session& session, const StaticSetup& setup, const TruthOptions& truth_options);
[[nodiscard]] std::string grid_table(const std::vector<double>& rmse);

// A line for each point; points on the Pareto front are marked.
[[nodiscard]] std::string table_of(const Trade& trade, const std::string& clock_title);

[[nodiscard]] nlohmann::ordered_json to_json(const Trade& trade);

}  // namespace alcove::sample
