// The GPU budget: the cost of the presets as a file, which a test compares with the model.
//
//   alcove cost --write-budget tests/sample/gpu_budget.json
//
// rewrites the file. A change of a pass's cost must do so in the same commit. The file has a line
// of JSON for the compiler, whose code determines the costs, then one for each pass of the settings
// on each GPU.
#pragma once

#include <string>
#include <vector>

#include "gpu_cost/cost_report.h"

namespace alcove::sample {

// Returns the settings that a budget covers: every preset except `reference`, and `medium` with
// bent normals and with specular occlusion.
[[nodiscard]] std::vector<LabelledSettings> budgeted_settings();

[[nodiscard]] std::string format_budget(const std::vector<SettingsCost>& costs,
                                        const std::string& compiler);

}  // namespace alcove::sample
