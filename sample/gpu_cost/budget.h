// The most that the shipped presets may cost: a file that the tests hold the shaders to.
//
//   alcove cost --write-budget tests/sample/gpu_budget.json
//
// rewrites it. A change that makes a pass slower fails a test until it does so in the same commit.
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
// What a budget covers: every preset but the reference, and medium with bent normals and with
// specular occlusion.
[[nodiscard]] std::vector<BudgetedSettings> budgeted_settings();

// The costs of these on all parts. Errors: as create_null_device() and modelled_frames() have them.
[[nodiscard]] tl::expected<std::vector<SettingsCost>, std::string> budgeted_costs();

// The driver whose compiler made the pipelines. Another one makes others.
[[nodiscard]] std::string compiler_name(const NullDevice& device);

[[nodiscard]] nlohmann::ordered_json budget_of(const std::vector<SettingsCost>& costs,
                                               const std::string& compiler);

// A sentence for each figure over its budget: instructions per pixel by more than 1 %, vector
// registers or spilled registers by any, fewer waves per SIMD, or a pass without a budget. What
// costs less than its budget is fine.
[[nodiscard]] std::vector<std::string> over_budget(const nlohmann::ordered_json& budget,
                                                   const std::vector<SettingsCost>& costs);

}  // namespace alcove::sample
