#pragma once

#include <vector>

#include "alcove/passes/setting_table.h"

namespace alcove::sample {

// The presets in order of cost, without `height_field`, which is not meant for frames in real time.
[[nodiscard]] inline std::vector<AlcoveQuality> presets() {
  std::vector<AlcoveQuality> all;
  for (std::size_t i = 0; i < passes::kQualityNames.size(); ++i)
    if (const auto quality = static_cast<AlcoveQuality>(i); quality != ALCOVE_QUALITY_HEIGHT_FIELD)
      all.push_back(quality);
  return all;
}

}  // namespace alcove::sample
