#pragma once

#include <string>

#include "evaluate/trade.h"

namespace alcove::sample {

// Error over time as an SVG image: time on a logarithmic axis, the Pareto front as a line, spreads
// as bars, and the points on the front named where their names overlap nothing. There is at least
// one point, and all times are over 0.
[[nodiscard]] std::string plot_of(const Trade& trade, const std::string& title,
                                  const std::string& clock_title);

}  // namespace alcove::sample
