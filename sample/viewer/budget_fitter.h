#pragma once

#include <cstdint>
#include <vector>

#include "gpu/gpu.h"
#include "gpu/occlusion.h"

namespace alcove::sample {

// Fits settings to a time, frame by frame: collects the times of the frames that were drawn with
// the same settings.
class BudgetFitter {
 public:
  // Adds the pass times of the frame that the device has finished last, and returns the settings of
  // the next frame. `settings` are those of the last frame; they may differ from the settings that
  // the last call returned. Settings that alcoveFitBudget refuses are returned unchanged.
  [[nodiscard]] OcclusionSettings fit(const AlcoveBudget& budget,
                                      const std::vector<PassTime>& times,
                                      const OcclusionSettings& settings);

 private:
  std::vector<double> milliseconds_;  // the newest last
  OcclusionSettings settings_;
  std::uint32_t frames_ = 0;  // since the settings changed
};

}  // namespace alcove::sample
