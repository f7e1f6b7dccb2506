#ifndef ALCOVE_SAMPLE_SETTINGS_H_
#define ALCOVE_SAMPLE_SETTINGS_H_

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <tl/expected.hpp>

#include "alcove/passes/gtso.h"
#include "alcove/passes/occlusion.h"
#include "options.h"

namespace alcove::sample {

// The occlusion settings that the options ask for: a quality, a radius (the scene's own where none
// is given), and whatever --set changes. Errors name the setting and what it takes.
[[nodiscard]] tl::expected<passes::OcclusionSettings, std::string> occlusion_settings(
    const OcclusionOptions& options, const Scene& scene);

// How specular occlusion is found: `--set specular_model=...`, else by the table.
[[nodiscard]] tl::expected<passes::SpecularModel, std::string> specular_model(
    const OcclusionOptions& options);
[[nodiscard]] std::string name_of(passes::SpecularModel model);

// Every setting by the name that --set knows it by.
[[nodiscard]] nlohmann::ordered_json to_json(const passes::OcclusionSettings& settings);

}  // namespace alcove::sample

#endif  // ALCOVE_SAMPLE_SETTINGS_H_
