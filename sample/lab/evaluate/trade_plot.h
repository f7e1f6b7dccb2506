#pragma once

#include <string>

#include "evaluate/trade.h"

namespace alcove::sample {

// Returns a plot of error over time as an SVG image: time on a logarithmic axis, the Pareto front
// as a line, spreads as bars, and the names of the points on the front where they overlap nothing.
// `trade` has at least one point, and all its times are above 0.
[[nodiscard]] std::string draw_plot(const Trade& trade, const std::string& title,
                                    const std::string& clock_title);

}  // namespace alcove::sample
