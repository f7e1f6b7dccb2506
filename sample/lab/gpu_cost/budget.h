// The GPU budget: upper limits for the cost of the presets, which the tests check.
//
//   alcove cost --write-budget tests/sample/gpu_budget.json
//
// rewrites the file of limits. A change that makes a pass slower must do so in the same commit.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "gpu_cost/cost_report.h"

namespace alcove::sample {

// Settings whose cost is modelled, and their name in tables and files.
struct LabelledSettings {
  std::string label;
  CostInputs inputs;
  std::string label_without;  // as SettingsCost::label_without
};

// Returns the settings `plain` with bent normals, and `plain` with specular occlusion from the
// slices. Both name `plain` as the settings to compare with (LabelledSettings::label_without).
[[nodiscard]] std::array<LabelledSettings, 2> with_each_output(const LabelledSettings& plain);

// The costs of `settings` on a GPU. Errors: those of modelled_frames().
[[nodiscard]] tl::expected<SettingsCost, std::string> cost_of(const GpuPart& part,
                                                              const NullDevice& device,
                                                              const LabelledSettings& settings);

// Returns the settings that a budget covers: every preset except `reference`, and `medium` with
// bent normals and with specular occlusion.
[[nodiscard]] std::vector<LabelledSettings> budgeted_settings();

// Returns the costs of these settings on all modelled GPUs. Errors: those of create_null_device()
// and modelled_frames().
[[nodiscard]] tl::expected<std::vector<SettingsCost>, std::string> budgeted_costs();

// The name and version of the driver, whose compiler determines the costs.
[[nodiscard]] std::string compiler_name(const NullDevice& device);

[[nodiscard]] nlohmann::ordered_json budget_of(const std::vector<SettingsCost>& costs,
                                               const std::string& compiler);

// Returns a sentence for each figure that exceeds its budget: more than 1 % more instructions per
// pixel, more vector registers or spilled registers, fewer waves per SIMD, or a pass without a
// budget.
[[nodiscard]] std::vector<std::string> over_budget(const nlohmann::ordered_json& budget,
                                                   const std::vector<SettingsCost>& costs);

}  // namespace alcove::sample
