#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <tl/expected.hpp>

#include "alcove/passes/occlusion.h"
#include "options/options.h"

namespace alcove::sample {

// The occlusion settings that the options ask for: a quality, a radius (the scene's own where none
// is given), and whatever --set changes. Errors name the setting and what it takes.
[[nodiscard]] tl::expected<passes::OcclusionSettings, std::string> occlusion_settings(
    const OcclusionOptions& options, const Scene& scene);

// Every setting by the name that --set knows it by.
[[nodiscard]] nlohmann::ordered_json to_json(const passes::OcclusionSettings& settings);

}  // namespace alcove::sample
