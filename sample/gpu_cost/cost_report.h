// What `alcove cost` prints and writes.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "gpu_cost/modelled_frame.h"

namespace alcove::sample {

// The costs of one choice of settings on one part.
struct SettingsCost {
  std::string label;  // a preset's name, say
  std::string family;
  std::vector<ModelledFrame> frames;
};

// A table for each part, with the passes of each frame and their sums. With `loops`, also the
// instructions of a wave by kind, and every loop that the compiler left with its iterations.
[[nodiscard]] std::string table_of(std::span<const SettingsCost> costs, bool loops);
[[nodiscard]] nlohmann::ordered_json to_json(std::span<const SettingsCost> costs);
// An SVG image: for each part, and each frame of each label, a bar of the passes' times.
[[nodiscard]] std::string chart_of(std::span<const SettingsCost> costs);

}  // namespace alcove::sample
