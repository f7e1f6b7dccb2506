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

// Draws the session's view in every way to spend time on it and compares each with the truths.
[[nodiscard]] tl::expected<std::vector<TradePoint>, std::string> measure_trade(
    const Session& session, const StaticSetup& setup, const TruthOptions& truth_options);

// A line for each point, those on the front marked.
[[nodiscard]] std::string table_of(const Trade& trade);

[[nodiscard]] nlohmann::ordered_json to_json(const Trade& trade);

}  // namespace alcove::sample
