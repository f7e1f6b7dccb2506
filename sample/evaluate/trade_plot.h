#pragma once

#include <string>

#include "evaluate/trade.h"

namespace alcove::sample {

// Error over GPU time as an SVG file: time on a logarithmic axis, the front as a line, its points
// named. There is at least one point, and all times are over 0.
[[nodiscard]] std::string plot_of(const Trade& trade, const std::string& title);

}  // namespace alcove::sample
