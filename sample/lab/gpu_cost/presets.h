#pragma once

#include <vector>

#include "alcove/passes/setting_names.h"

namespace alcove::sample {

// The presets in order of cost, without `reference`, which is not meant for frames in real time.
[[nodiscard]] inline std::vector<passes::Quality> presets() {
  std::vector<passes::Quality> all;
  for (std::size_t i = 0; i < passes::kNames<passes::Quality>.size(); ++i)
    if (const auto quality = static_cast<passes::Quality>(i); quality != passes::Quality::reference)
      all.push_back(quality);
  return all;
}

}  // namespace alcove::sample
