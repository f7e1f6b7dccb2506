#pragma once

#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "alcove/passes/occlusion.h"
#include "cli/options.h"
#include "scene/scene.h"

namespace alcove::sample {

// The occlusion settings that the options ask for: a quality, a radius (the scene's own where none
// is given), and whatever --set changes. Errors name the setting and what it may be.
[[nodiscard]] tl::expected<passes::OcclusionSettings, std::string> occlusion_settings(
    const OcclusionOptions& options, const Scene& scene);

// The allowed names or values, if the name of --set NAME=VALUE is unknown or its value is out of
// range; nothing if it is right. Combinations are checked by occlusion_settings().
[[nodiscard]] std::optional<std::string> wanted_instead(const std::string& name,
                                                        const std::string& value);

// All settings, a line each: name, meaning, range, default.
[[nodiscard]] std::string settings_help();

}  // namespace alcove::sample
