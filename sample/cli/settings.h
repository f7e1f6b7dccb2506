#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cli/options.h"
#include "evaluate/recommendation.h"
#include "gpu/occlusion.h"
#include "support/result.h"

namespace alcove::sample {

// Returns the occlusion settings of the options: those of a file or a quality, a radius in scene
// units (by default `default_radius`), and the changes by --set. Error: settings that contradict
// each other.
[[nodiscard]] Result<OcclusionSettings> occlusion_settings(const OcclusionOptions& options,
                                                           float default_radius);

// Whether --set changes the radius.
[[nodiscard]] bool changes_radius(const OcclusionOptions& options);
// Where the radius comes from if the options give it, else an empty text.
[[nodiscard]] std::string radius_source(const OcclusionOptions& options);

// Returns a sentence for each --set that has no effect with the other settings.
[[nodiscard]] std::vector<std::string> ineffective_changes(const OcclusionOptions& options,
                                                           const OcclusionSettings& settings);

// Reads NAME=VALUE of an option --set. The error is what to give instead: the allowed names or
// values.
[[nodiscard]] Result<SettingChange> read_change(std::string_view text);
// Returns the change as NAME=VALUE.
[[nodiscard]] std::string change_text(const SettingChange& change);

// Returns a text with one line for each setting: name, meaning, range, default.
[[nodiscard]] std::string settings_help();

// Reads a file in the form of alcoveReadSettings(). The result has a radius of 0 if the file has
// none. The error completes the sentence "give ...".
[[nodiscard]] Result<OcclusionSettings> read_settings(std::string_view file);
// Returns the contents of such a file: every setting but the radius, which belongs to the scene,
// after a comment on the guard band if there is one.
[[nodiscard]] std::string settings_text(const Choice& choice);

// The preset of --quality, or all presets for frames in real time if it was not given.
[[nodiscard]] std::vector<AlcoveQuality> chosen_presets(const OcclusionOptions& options);

}  // namespace alcove::sample
