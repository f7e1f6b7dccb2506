#pragma once

#include <nlohmann/json_fwd.hpp>

#include "alcove/passes/occlusion.h"

namespace alcove::sample {

// Returns every occlusion setting that --set accepts, by its name, as a JSON object.
[[nodiscard]] nlohmann::ordered_json to_json(const passes::OcclusionSettings& settings);

}  // namespace alcove::sample
