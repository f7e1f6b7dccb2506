#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/option_value.h"
#include "cli/options.h"
#include "gpu/occlusion.h"
#include "support/result.h"

namespace alcove::sample {

// Returns the occlusion settings of the options: a quality, a radius in scene units (by default
// `default_radius`), and the changes by --set. Errors name the setting and its allowed values.
[[nodiscard]] Result<OcclusionSettings> occlusion_settings(const OcclusionOptions& options,
                                                           float default_radius);

// Checks NAME and VALUE of an option --set. Returns the allowed names if the name is unknown, the
// allowed values if the value is out of range, and nothing if both are valid. Settings that depend
// on each other are checked by occlusion_settings().
[[nodiscard]] std::optional<std::string> wanted_instead(const std::string& name,
                                                        const std::string& value);

// Returns a text with one line for each setting: name, meaning, range, default.
[[nodiscard]] std::string settings_help();

// Reads a file that `alcove recommend --out` wrote, in the form of alcoveReadSettings(). Errors:
// the file cannot be read, a line has another form, or a name or value is not allowed.
[[nodiscard]] Result<std::string> read_settings(const std::string& file);
// Returns the contents of such a file: every setting but the radius, which belongs to the scene.
[[nodiscard]] std::string settings_text(const OcclusionSettings& settings);

// The preset of --quality, or all presets for frames in real time if it was not given.
[[nodiscard]] std::vector<AlcoveQuality> chosen_presets(const OcclusionOptions& options);

}  // namespace alcove::sample
