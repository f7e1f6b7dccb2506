#pragma once

#include <nlohmann/json.hpp>

#include "cli/options.h"
#include "render/rendering.h"

namespace alcove::sample {

// Returns the contents of `report.json` for a rendering: device, settings, view, timings and
// memory. Commands that compute a truth add `errors`.
[[nodiscard]] nlohmann::ordered_json rendering_report(const Rendering& rendering,
                                                      const Options& options);

// The times of a rendering as a table.
[[nodiscard]] std::string time_table(const Rendering& rendering);

}  // namespace alcove::sample
