// The tables and files of `alcove cost`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "gpu_cost/modelled_frame.h"

namespace alcove::sample {

// The costs of one choice of settings on one GPU.
struct SettingsCost {
  std::string label;   // such as the name of a preset
  std::string family;  // of the GPU, as GpuPart::family
  std::vector<ModelledFrame> frames;
  // The label of the settings that equal these except for one output. The report compares the times
  // of both. If it is empty, there is no comparison.
  std::string label_without;
};

// Returns the costs as text: a table for each GPU, with the passes of each frame and their sums.
// With `loops`, also the instructions of a wave by kind, and each loop of the compiled shader with
// its number of iterations. The ratios of output_ratios() follow, if there are any.
[[nodiscard]] std::string table_of(std::span<const SettingsCost> costs, bool loops);
[[nodiscard]] nlohmann::ordered_json to_json(std::span<const SettingsCost> costs);

// Returns, for each frame of `cost`, its modelled time divided by the time of the same frame
// without the output (LabelledSettings::label_without). The result is empty if `cost` names no such
// settings, or if `costs` does not contain them for the same GPU.
[[nodiscard]] std::vector<double> output_ratios(const SettingsCost& cost,
                                                std::span<const SettingsCost> costs);
// An SVG image: for each GPU, a bar of the passes' times for each frame of each label.
[[nodiscard]] std::string chart_of(std::span<const SettingsCost> costs);

}  // namespace alcove::sample
