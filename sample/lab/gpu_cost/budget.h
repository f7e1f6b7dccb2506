// The GPU budget: upper limits for the cost of the presets, which the tests check.
//
//   alcove cost --write-budget tests/sample/gpu_budget.json
//
// rewrites the file of limits. A change that makes a pass slower must do so in the same commit. The
// file has a line of JSON for the compiler, then one for each pass of the settings on each GPU.
#pragma once

#include <string>
#include <vector>

#include "gpu_cost/cost_report.h"
#include "support/result.h"

namespace alcove::sample {

// Returns the settings that a budget covers: every preset except `reference`, and `medium` with
// bent normals and with specular occlusion.
[[nodiscard]] std::vector<LabelledSettings> budgeted_settings();

[[nodiscard]] std::string format_budget(const std::vector<SettingsCost>& costs,
                                        const std::string& compiler);

// Returns a sentence for each figure that does not keep its budget: more than 1 % more or fewer
// instructions per pixel (a model that forgets a loop finds fewer), more vector registers or
// spilled registers, fewer waves per SIMD, or a pass without a budget. Error: the budget is for
// another compiler, whose code is different.
[[nodiscard]] Result<std::vector<std::string>> over_budget(const std::string& budget,
                                                           const std::string& compiler,
                                                           const std::vector<SettingsCost>& costs);

}  // namespace alcove::sample
