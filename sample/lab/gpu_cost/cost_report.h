// The tables and files of `alcove cost`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "gpu_cost/modelled_frame.h"
#include "support/result.h"

namespace alcove::sample {

// Settings whose cost is modelled.
struct LabelledSettings {
  std::string label;  // such as the name of a preset
  CostInputs inputs;
};

// The costs of one choice of settings on one GPU.
struct SettingsCost {
  LabelledSettings settings;
  const GpuPart* part = nullptr;
  std::string compiler;               // of the shaders, as NullDevice::compiler
  std::vector<ModelledFrame> frames;  // for a finite far plane
  // Milliseconds of a moving frame under each of kCacheAssumptions; empty if they are not wanted.
  std::vector<double> assumed_ms;
};

// The costs of all these settings on each GPU of the model, or on `only`. With `range`, also under
// each of kCacheAssumptions. Errors: those of create_null_device() and modelled_frames().
[[nodiscard]] Result<std::vector<SettingsCost>> model_costs(
    std::span<const LabelledSettings> settings, const GpuPart* only, bool range);

// Returns the costs as text: a table for each GPU, with the passes of each frame and their sums.
[[nodiscard]] std::string format_table(std::span<const SettingsCost> costs);
[[nodiscard]] nlohmann::ordered_json to_json(std::span<const SettingsCost> costs);

}  // namespace alcove::sample
