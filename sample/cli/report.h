#pragma once

#include <nlohmann/json.hpp>

#include "cli/options.h"
#include "render/rendering.h"

namespace alcove::sample {

// What `report.json` says of a rendering: device, settings, view, timings, memory. `errors` is
// added by those that know a truth.
[[nodiscard]] nlohmann::ordered_json report_of(const Rendering& rendering, const Options& options);

// The times of a rendering as a table for people.
[[nodiscard]] std::string time_table(const Rendering& rendering);

}  // namespace alcove::sample
