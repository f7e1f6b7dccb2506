#include "evaluate/sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "gpu_cost/presets.h"

namespace alcove::sample {
namespace {

TEST(PresetSweep, SweepContainsEachPresetOnceAndNoDuplicateSettings) {
  for (const AlcoveQuality quality : presets()) {
    const OcclusionSettings base = OcclusionSettings(quality, 0.5f);
    const std::vector<Variant> ways = preset_sweep(base);
    EXPECT_GE(ways.size(), 16u);
    std::vector<OcclusionSettings> seen;
    for (const Variant& way : ways) {
      EXPECT_TRUE(passes::validate(way.settings)) << way.name;
      EXPECT_EQ(std::ranges::count(seen, way.settings), 0) << way.name;
      seen.push_back(way.settings);
    }
    for (const AlcoveQuality preset : presets()) {
      OcclusionSettings settings(preset, base.radius);
      settings.depth_layers = std::max(settings.depth_layers, base.depth_layers);
      EXPECT_EQ(std::ranges::count(seen, settings), 1) << passes::kQualityNames.at(preset);
    }
  }
}

TEST(PresetSweep, SweepChangesOnlyNumbersOfSamplesHalfResolutionAndDepthLayers) {
  OcclusionSettings base = OcclusionSettings(ALCOVE_QUALITY_MEDIUM, 2.0f);
  base.history_frames = 0;
  base.estimator = ALCOVE_ESTIMATOR_HORIZONS;
  base.hidden_occlusion = 0.1f;
  for (const Variant& way : preset_sweep(base)) {
    OcclusionSettings settings = with_samples(way.settings, base);
    settings.depth_layers = base.depth_layers;
    EXPECT_EQ(settings, base) << way.name;
  }
}

}  // namespace
}  // namespace alcove::sample
