// The tables and files of `alcove cost`.
#pragma once

#include <array>
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
  // The label of the settings that equal these except for one output. The report compares the times
  // of both. If it is empty, there is no comparison.
  std::string label_without;
};

// Returns the settings `plain` with bent normals, and `plain` with specular occlusion from the
// slices. Both name `plain` as the settings to compare with.
[[nodiscard]] std::array<LabelledSettings, 2> with_each_output(const LabelledSettings& plain);

// The costs of one choice of settings on one GPU.
struct SettingsCost {
  LabelledSettings settings;
  const GpuPart* part = nullptr;
  std::vector<ModelledFrame> frames;   // for a finite far plane
  std::vector<Occupancy> occupancies;  // of each pass, for each kind of projection
};

// Errors: those of modelled_frames().
[[nodiscard]] Result<SettingsCost> model_cost(const GpuPart& part, const NullDevice& device,
                                              const LabelledSettings& settings);

// The costs of all these settings on each GPU of the model, or on `only`. Errors: those of
// create_null_device() and modelled_frames().
[[nodiscard]] Result<std::vector<SettingsCost>> model_costs(
    std::span<const LabelledSettings> settings, const GpuPart* only = nullptr);

// Returns the costs as text: a table for each GPU, with the passes of each frame and their sums.
// With `loops`, also the instructions of a wave by kind, each loop of the compiled shader with its
// number of iterations, and each branch that not every wave executes. The ratios of output_ratios()
// follow, if there are any.
[[nodiscard]] std::string format_table(std::span<const SettingsCost> costs, bool loops);
[[nodiscard]] nlohmann::ordered_json to_json(std::span<const SettingsCost> costs);

// Returns, for each frame of `cost`, its modelled time divided by the time of the same frame
// without the output (LabelledSettings::label_without). The result is empty if `cost` names no such
// settings, or if `costs` does not contain them for the same GPU.
[[nodiscard]] std::vector<double> output_ratios(const SettingsCost& cost,
                                                std::span<const SettingsCost> costs);
}  // namespace alcove::sample
