// The GPU budget: upper limits for the cost of the presets, which the tests check.
//
//   alcove cost --write-budget tests/sample/gpu_budget.json
//
// rewrites the file of limits. A change that makes a pass slower must do so in the same commit.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "gpu_cost/cost_report.h"

namespace alcove::sample {

struct BudgetedSettings {
  std::string label;
  CostInputs inputs;
};
// The settings that a budget covers: every preset except `reference`, and `medium` with bent
// normals and with specular occlusion.
[[nodiscard]] std::vector<BudgetedSettings> budgeted_settings();

// The costs of these settings on all GPUs. Errors: those of create_null_device() and
// modelled_frames().
[[nodiscard]] tl::expected<std::vector<SettingsCost>, std::string> budgeted_costs();

// The name and version of the driver, whose compiler determines the costs.
[[nodiscard]] std::string compiler_name(const NullDevice& device);

[[nodiscard]] nlohmann::ordered_json budget_of(const std::vector<SettingsCost>& costs,
                                               const std::string& compiler);

// A sentence for each figure that exceeds its budget: more than 1 % more instructions per pixel,
// more vector registers or spilled registers, fewer waves per SIMD, or a pass without a budget.
[[nodiscard]] std::vector<std::string> over_budget(const nlohmann::ordered_json& budget,
                                                   const std::vector<SettingsCost>& costs);

}  // namespace alcove::sample
