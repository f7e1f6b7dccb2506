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
  // The label of the same settings without an output, with which these settings are compared.
  // Empty: no comparison.
  std::string label_without;
};

// A table for each GPU, with the passes of each frame and their sums. With `loops`, also the
// instructions of a wave by kind, and each loop of the compiled shader with its iterations. Then
// the ratios of output_ratios(), if there are any.
[[nodiscard]] std::string table_of(std::span<const SettingsCost> costs, bool loops);
[[nodiscard]] nlohmann::ordered_json to_json(std::span<const SettingsCost> costs);

// For each frame of `cost`: its modelled time over the time of the same frame without the output.
// Empty if `cost` names no settings without the output, or if `costs` does not contain them for the
// same GPU.
[[nodiscard]] std::vector<double> output_ratios(const SettingsCost& cost,
                                                std::span<const SettingsCost> costs);
// An SVG image: for each GPU, a bar of the passes' times for each frame of each label.
[[nodiscard]] std::string chart_of(std::span<const SettingsCost> costs);

}  // namespace alcove::sample
