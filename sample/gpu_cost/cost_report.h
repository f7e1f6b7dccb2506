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
  std::string label;  // such as the name of a preset
  std::string family;
  std::vector<ModelledFrame> frames;
};

// A table for each GPU, with the passes of each frame and their sums. With `loops`, also the
// instructions of a wave by kind, and each loop of the compiled shader with its iterations.
[[nodiscard]] std::string table_of(std::span<const SettingsCost> costs, bool loops);
[[nodiscard]] nlohmann::ordered_json to_json(std::span<const SettingsCost> costs);
// An SVG image: for each GPU, a bar of the passes' times for each frame of each label.
[[nodiscard]] std::string chart_of(std::span<const SettingsCost> costs);

}  // namespace alcove::sample
