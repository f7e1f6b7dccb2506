#include "evaluate/trade.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <regex>
#include <string>
#include <vector>

#include "evaluate/trade_plot.h"
#include "gpu_cost/presets.h"

namespace alcove::sample {
namespace {

using passes::OcclusionSettings;

Measurement point(const std::string& name, double time_ms, double rmse, double spread_ms = 0) {
  return {{"", name, {}}, {.rmse = rmse}, {.rmse = 0.5 * rmse}, {.bytes = 1000},
          time_ms,        spread_ms,      2.0 * time_ms};
}

TEST(PresetSweep, SweepContainsEachPresetOnceAndNoDuplicateSettings) {
  for (const passes::Quality quality : presets()) {
    const OcclusionSettings base = passes::quality_settings(quality, 0.5f);
    const std::vector<Variant> ways = preset_sweep(base);
    EXPECT_GE(ways.size(), 16u);
    std::vector<OcclusionSettings> seen;
    for (const Variant& way : ways) {
      EXPECT_EQ(std::ranges::count(seen, way.settings), 0) << way.name;
      seen.push_back(way.settings);
    }
    for (const passes::Quality preset : presets()) {
      OcclusionSettings settings = passes::quality_settings(preset, base.radius);
      settings.depth_layers = std::max(settings.depth_layers, base.depth_layers);
      EXPECT_EQ(std::ranges::count(seen, settings), 1) << passes::name_of(preset);
    }
  }
}

TEST(PresetSweep, SweepContainsHalfResolutionWithSeveralTileSizesAndSteps) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> half;
  for (const Variant& variant : preset_sweep({})) {
    EXPECT_TRUE(passes::validate(variant.settings)) << variant.name;
    if (variant.settings.half_resolution) {
      half.emplace_back(variant.settings.tile_size, variant.settings.steps);
      EXPECT_TRUE(variant.name == "console" ||
                  variant.name.find("half resolution") != std::string::npos)
          << variant.name;
    }
  }
  EXPECT_THAT(half, testing::IsSupersetOf({std::pair(8u, 4u), std::pair(8u, 8u), std::pair(4u, 8u),
                                           std::pair(2u, 10u)}));
}

TEST(PresetSweep, SweepChangesOnlyNumbersOfSamplesHalfResolutionAndDepthLayers) {
  OcclusionSettings base = passes::quality_settings(passes::Quality::medium, 2.0f);
  base.history_frames = 0;
  base.advanced.estimator = passes::Estimator::horizons;
  base.hidden_occlusion = 0.1f;
  for (const Variant& way : preset_sweep(base)) {
    OcclusionSettings settings = way.settings;
    settings.tile_size = base.tile_size;
    settings.slices = base.slices;
    settings.steps = base.steps;
    settings.half_resolution = base.half_resolution;
    settings.depth_layers = base.depth_layers;
    EXPECT_EQ(settings, base) << way.name;
  }
}

TEST(SpeedErrorTrade, ParetoFrontOfTimeAndErrorExcludesDominatedSettings) {
  const Trade trade =
      find_pareto_front({point("slow", 9, 0.01), point("fast", 1, 0.1), point("worse", 4, 0.2),
                         point("fair", 3, 0.05), point("equal", 5, 0.05)});
  std::vector<std::string> names;
  for (const Measurement& each : trade.points) names.push_back(each.variant.name);
  EXPECT_EQ(names, (std::vector<std::string>{"fast", "fair", "worse", "equal", "slow"}));
  EXPECT_EQ(trade.on_pareto_front, (std::vector<bool>{true, true, false, false, true}));
}

TEST(SpeedErrorTrade, LessAccurateSettingFasterOnlyWithinMeasurementSpreadIsNotOnTheParetoFront) {
  const Trade trade =
      find_pareto_front({point("no faster", 10.0, 0.06, 0.3), point("nearer", 10.4, 0.05, 0.2),
                         point("surely faster", 9.0, 0.08, 0.3)});
  EXPECT_EQ(trade.on_pareto_front, (std::vector<bool>{true, false, true}));
}

TEST(SpeedErrorTrade, ParetoFrontDoesNotChangeWithTimingNoiseWithinTheMeasuredSpread) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-0.07, 0.07);
  for (int run = 0; run < 100; ++run) {
    const Trade trade = find_pareto_front({point("a", 2.0 + noise(random), 0.06, 0.1),
                                           point("b", 2.05 + noise(random), 0.05, 0.1),
                                           point("c", 3.0 + noise(random), 0.04, 0.1)});
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_EQ(trade.on_pareto_front[i], trade.points[i].variant.name != "a") << run;
  }
}

// A setting with its true time, relative to the base settings.
struct TrueSetting {
  const char* name;
  double time;
  double rmse;
};

// Measures settings on a simulated machine on which other programs run. They slow down both frames
// of a pair by a common factor, each frame by a few per cent, and one frame in ten by up to three
// times. The base settings take 5 ms.
std::vector<Measurement> measured_on_a_busy_machine(std::span<const TrueSetting> settings,
                                                    std::mt19937& random) {
  std::lognormal_distribution<double> common(0.0, 0.4);
  std::normal_distribution<double> own(1.0, 0.04);
  std::uniform_real_distribution<double> stall(1.2, 3.0);
  std::bernoulli_distribution stalls(0.1);
  const auto frame = [&](double ms) {
    ms *= std::max(own(random), 0.5);
    return FrameTimes{0.0, stalls(random) ? ms * stall(random) : ms};
  };
  std::vector<Measurement> points;
  for (const TrueSetting& setting : settings) {
    std::vector<TimedPair> pairs;
    for (std::uint32_t i = 0; i < kDecidingPairs; ++i) {
      const double base_ms = 5.0 * common(random);
      pairs.push_back({frame(base_ms), frame(base_ms * setting.time)});
    }
    const VariantCost cost = median_cost(pairs, 1000);
    points.push_back(
        point(setting.name, 5.0 * cost.processor, setting.rmse, 5.0 * cost.processor_spread));
  }
  return points;
}

std::vector<std::string> sorted_front(const Trade& trade) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < trade.points.size(); ++i)
    if (trade.on_pareto_front[i]) names.push_back(trade.points[i].variant.name);
  std::ranges::sort(names);
  return names;
}

constexpr std::array<TrueSetting, 6> kTrueSettings{{{"fast", 0.3, 0.08},
                                                    {"as fast but worse", 0.3, 0.09},
                                                    {"fair", 1.0, 0.05},
                                                    {"as slow but worse", 1.0, 0.06},
                                                    {"slow", 4.0, 0.04},
                                                    {"slow and worse", 4.0, 0.07}}};

TEST(SpeedErrorTrade, RepeatedMeasurementsOnABusyMachineGiveTheSameParetoFront) {
  std::mt19937 random(5);
  for (int run = 0; run < 200; ++run) {
    EXPECT_THAT(sorted_front(find_pareto_front(measured_on_a_busy_machine(kTrueSettings, random))),
                testing::ElementsAre("fair", "fast", "slow"));
  }
}

TEST(SpeedErrorTrade, SettingThatBecomesFasterEntersTheParetoFrontOnABusyMachine) {
  std::mt19937 random(5);
  auto settings = kTrueSettings;
  settings[3] = {"faster but worse", 0.4, 0.06};
  settings[0].time = settings[1].time = 0.1;
  for (int run = 0; run < 200; ++run) {
    EXPECT_THAT(sorted_front(find_pareto_front(measured_on_a_busy_machine(settings, random))),
                testing::ElementsAre("fair", "fast", "faster but worse", "slow"));
  }
}

TEST(VariantCost, CostIsTheMedianRatioOfTimedPairsWithHalfTheInterquartileRangeAsSpread) {
  std::vector<TimedPair> pairs;
  for (const double ratio : {2.0, 1.0, 9.0, 3.0, 4.0})
    pairs.push_back({{10.0, 7.0}, {10.0 * ratio, 14.0 * ratio}});
  const VariantCost cost = median_cost(pairs, 5);
  EXPECT_DOUBLE_EQ(cost.gpu, 3.0);
  EXPECT_DOUBLE_EQ(cost.gpu_spread, 1.0);
  EXPECT_DOUBLE_EQ(cost.processor, 6.0);
  EXPECT_DOUBLE_EQ(cost.processor_spread, 2.0);
  EXPECT_EQ(cost.bytes, 5u);
  EXPECT_EQ(median_cost({}, 5).gpu, 1.0);
}

TEST(SpeedErrorTrade, OnlyOneOfSeveralEqualSettingsIsOnTheParetoFront) {
  const Trade trade = find_pareto_front({point("a", 1, 0.1), point("b", 1, 0.1)});
  EXPECT_EQ(trade.on_pareto_front, (std::vector<bool>{true, false}));
}

TEST(SamplingGrid, GridHasEveryPairOfStepsAndSlicesOrderedBySteps) {
  const OcclusionSettings base = passes::quality_settings(passes::Quality::high, 0.5f);
  const std::vector<Variant> grid = sampling_grid(base);
  ASSERT_EQ(grid.size(), kGridSteps.size() * kGridSlices.size());
  for (std::size_t i = 0; i < grid.size(); ++i) {
    OcclusionSettings expected = base;
    expected.steps = kGridSteps[i / kGridSlices.size()];
    expected.slices = kGridSlices[i % kGridSlices.size()];
    EXPECT_EQ(grid[i].settings, expected);
  }
}

TEST(SpeedErrorTrade, SeveralScenesAreCombinedByMeanTimeAndRootMeanSquareError) {
  const std::vector<std::vector<Measurement>> scenes{{point("a", 1, 0.3)}, {point("a", 3, 0.4)}};
  const std::vector<Measurement> all = over_scenes(scenes);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_DOUBLE_EQ(all[0].time_ms, 2.0);
  EXPECT_DOUBLE_EQ(all[0].processor_ms, 4.0);
  EXPECT_NEAR(all[0].scene.rmse, std::sqrt(0.125), 1e-12);
  EXPECT_EQ(all[0].cost.bytes, 1000u);
}

TEST(TradePlot, PlotLabelsOnlyPointsOnTheParetoFrontAndEscapesText) {
  const std::string plot = draw_plot(
      find_pareto_front({point("fast", 1, 0.1), point("a < b", 30, 0.05), point("off", 40, 0.06)}),
      "scene & size", "modelled time");
  EXPECT_NE(plot.find(">fast</text>"), std::string::npos);
  EXPECT_NE(plot.find(">a &lt; b</text>"), std::string::npos);
  EXPECT_NE(plot.find("scene &amp; size"), std::string::npos);
  EXPECT_EQ(plot.find(">off</text>"), std::string::npos);
  EXPECT_EQ(plot.find("nan"), std::string::npos);
  EXPECT_EQ(plot.find("inf"), std::string::npos);
}

// The left edge, baseline and width of each name, as the plot estimates them.
struct PlacedName {
  double left, baseline, width;
};

std::vector<PlacedName> placed_names(const std::string& plot, const std::string& prefix) {
  std::vector<PlacedName> names;
  const std::regex text(
      "<text x=\"([0-9.e+-]+)\" y=\"([0-9.e+-]+)\" text-anchor=\"(start|end)\">(" + prefix +
      "[^<]*)<");
  for (std::sregex_iterator at(plot.begin(), plot.end(), text), end; at != end; ++at) {
    const double width = 6.6 * static_cast<double>((*at)[4].length());
    const double x = std::stod((*at)[1]);
    names.push_back({(*at)[3] == "start" ? x : x - width, std::stod((*at)[2]), width});
  }
  return names;
}

TEST(TradePlot, LabelsOfAdjacentPointsInThePlotDoNotOverlap) {
  std::vector<Measurement> points;
  for (int i = 0; i < 9; ++i) {
    points.push_back(
        point("setting number " + std::to_string(i), 1.0 + 0.02 * i, 0.1 - 0.0005 * i));
  }
  const std::vector<PlacedName> names =
      placed_names(draw_plot(find_pareto_front(points), "close", "time"), "setting number");
  ASSERT_EQ(names.size(), points.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const bool apart = std::abs(names[i].baseline - names[j].baseline) >= 12 ||
                         names[i].left >= names[j].left + names[j].width ||
                         names[j].left >= names[i].left + names[i].width;
      EXPECT_TRUE(apart) << i << " and " << j;
    }
  }
}

TEST(TradePlot, PlotOfASinglePointIsValid) {
  const std::string plot = draw_plot(find_pareto_front({point("only", 1, 0.0)}), "one", "time");
  EXPECT_NE(plot.find("<circle"), std::string::npos);
  EXPECT_EQ(plot.find("nan"), std::string::npos);
}

}  // namespace
}  // namespace alcove::sample
