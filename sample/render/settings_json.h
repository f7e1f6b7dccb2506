#pragma once

#include <nlohmann/json_fwd.hpp>

#include "gpu/occlusion.h"

namespace alcove::sample {

// Returns every occlusion setting that --set accepts, by its name, as a JSON object.
[[nodiscard]] nlohmann::ordered_json to_json(const OcclusionSettings& settings);

}  // namespace alcove::sample
