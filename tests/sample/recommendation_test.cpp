#include "evaluate/recommendation.h"
#include "alcove/passes/setting_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "evaluate/sweep.h"

namespace alcove::sample {
namespace {

// A world in which errors and times have closed forms: more samples take longer and err less, and a
// second layer takes 20 % of the error away for 15 % of the time.
struct World {
  double layer_gain = 0.2;
  double samples_of_dear_layer = 1e9;  // more samples than these cost three times as much with one
  double band_gain = 0.0;
  int renders = 0;
  int models = 0;  // calls for a time

  static double samples(const OcclusionSettings& s) {
    return static_cast<double>(s.slices * s.steps) /
           (s.tile_size * s.tile_size * (s.half_resolution ? 4 : 1));
  }
  double ms(const OcclusionSettings& s) const {
    const double layers = s.depth_layers == 1                  ? 1.0
                          : samples(s) > samples_of_dear_layer ? 4.5
                                                               : 1.5;
    return (s.half_resolution ? 0.3 : 1.0) + 0.4 * samples(s) * layers;
  }
  double rmse(const OcclusionSettings& s) const {
    const double hidden = 0.1 * std::abs(s.hidden_occlusion - 0.33);
    const double layers = s.depth_layers > 1 ? 1.0 - layer_gain : 1.0;
    const double horizons = s.estimator == ALCOVE_ESTIMATOR_HORIZONS ? 1.6 : 1.0;
    return (0.04 + 0.02 / (0.5 + samples(s)) + hidden + (s.half_resolution ? 0.01 : 0.0)) * layers *
           horizons;
  }
  RecommendationWorld functions() {
    return {[this](const Choice& choice) -> Result<std::array<double, 3>> {
              ++renders;
              const double error =
                  rmse(choice.settings) * (choice.guard_band > 0 ? 1 - band_gain : 1);
              return std::array{1.2 * error, error, 0.9 * error};
            },
            [this](const Choice& choice) -> Result<std::array<double, 3>> {
              ++models;
              const double time = ms(choice.settings) * (choice.guard_band > 0 ? 1.1 : 1.0);
              return std::array{time, time, 0.9 * time};
            },
            {},
            true,
            true};
  }
};

RecommendationGoal within_ms(double ms) { return {ms, std::nullopt}; }
RecommendationGoal within_rmse(double rmse) { return {std::nullopt, rmse}; }

// The best of every number of samples with and without a second layer and a guard band.
Achievement best_of_all(const RecommendationGoal& goal, World world) {
  std::optional<Achievement> best;
  const auto functions = world.functions();
  for (const Variant& variant : preset_sweep({})) {
    for (const std::uint32_t layers : {1u, 2u}) {
      for (const double band : {0.0, kGuardBand}) {
        Achievement found{{variant.settings, band}};
        found.choice.settings.depth_layers = layers;
        found.rmse = functions.rmse(found.choice).value();
        found.ms = functions.ms(found.choice).value();
        if (!best || goal.prefers(found, *best)) best = found;
      }
    }
  }
  return *best;
}

TEST(Recommendation, BudgetIsMetWithTheErrorOfABruteForceSearch) {
  for (const auto& [gain, band_gain] :
       {std::pair(0.0, 0.0), {0.2, 0.0}, {0.0, 0.08}, {0.2, 0.08}}) {
    for (const double ms : {0.5, 0.9, 1.3, 1.8, 3.0, 6.0, 40.0}) {
      World world{.layer_gain = gain, .band_gain = band_gain};
      const RecommendationGoal goal = within_ms(ms);
      const auto found = recommend({}, goal, world.functions());
      ASSERT_TRUE(found) << found.error();
      EXPECT_TRUE(goal.met(found->chosen)) << ms;
      EXPECT_LE(goal.rmse(found->chosen), 1.03 * goal.rmse(best_of_all(goal, world))) << ms;
      EXPECT_LE(world.renders, 24) << ms;
      EXPECT_LE(world.models, 52) << ms;
    }
  }
}

TEST(Recommendation, ToleranceIsMetInNearlyTheTimeOfABruteForceSearch) {
  for (const double gain : {0.0, 0.2}) {
    for (const double rmse : {0.09, 0.06, 0.05, 0.046}) {
      World world{gain};
      const RecommendationGoal goal = within_rmse(rmse);
      const auto found = recommend({}, goal, world.functions());
      ASSERT_TRUE(found) << found.error();
      EXPECT_TRUE(goal.met(found->chosen)) << rmse;
      EXPECT_LE(goal.ms(found->chosen), 1.1 * goal.ms(best_of_all(goal, world))) << rmse;
    }
  }
}

// The time of a second layer rises in steps where the search exceeds a cache.
TEST(Recommendation, FeatureThatIsCheapAtFewSamplesOnlyIsUsedThere) {
  for (const double gain : {0.15, 0.2, 0.3, 0.5}) {
    for (const double samples : {0.2, 0.4, 0.6, 0.9}) {
      for (double ms = 0.6; ms < 3.0; ms += 0.1) {
        World world{.layer_gain = gain, .samples_of_dear_layer = samples};
        const RecommendationGoal goal = within_ms(ms);
        const auto found = recommend({}, goal, world.functions());
        ASSERT_TRUE(found) << found.error();
        EXPECT_LE(goal.rmse(found->chosen), 1.03 * goal.rmse(best_of_all(goal, world)))
            << gain << " " << samples << " " << ms;
      }
    }
  }
}

TEST(Recommendation, ToleranceThatOnlyAFeatureReachesIsReached) {
  World world;
  const RecommendationGoal goal = within_rmse(0.036);
  const auto found = recommend({}, goal, world.functions());
  ASSERT_TRUE(found) << found.error();
  EXPECT_TRUE(goal.met(found->chosen));
  EXPECT_EQ(found->chosen.choice.settings.depth_layers, 2u);
}

TEST(Recommendation, ImpossibleGoalYieldsTheClosestSettings) {
  World world;
  const RecommendationGoal tolerance = within_rmse(0.001);
  const auto accurate = recommend({}, tolerance, world.functions());
  ASSERT_TRUE(accurate) << accurate.error();
  EXPECT_FALSE(tolerance.met(accurate->chosen));
  EXPECT_LT(tolerance.rmse(accurate->chosen), 0.04);
  const RecommendationGoal budget = within_ms(0.1);
  const auto fast = recommend({}, budget, world.functions());
  ASSERT_TRUE(fast) << fast.error();
  EXPECT_FALSE(budget.met(fast->chosen));
  EXPECT_LT(budget.ms(fast->chosen), 0.45);
}

TEST(Recommendation, EachFeatureHasASentenceAboutItsErrorAndTime) {
  World world;
  const auto found = recommend({}, within_ms(4), world.functions());
  ASSERT_TRUE(found) << found.error();
  const auto layer =
      std::ranges::find(found->features, "a second depth layer", &FeatureEffect::name);
  ASSERT_NE(layer, found->features.end());
  EXPECT_THAT(layer->sentence(),
              testing::StartsWith("a second depth layer: 20.0 % less error for"));
  EXPECT_THAT(layer->sentence(), testing::HasSubstr("more time; used"));
  // Thickness changes nothing in this world, so it is not chosen.
  const auto thickness =
      std::ranges::find(found->features, "a thickness of 0.05", &FeatureEffect::name);
  ASSERT_NE(thickness, found->features.end());
  EXPECT_EQ(
      thickness->sentence(),
      "a thickness of 0.05: no difference in error for no difference in time; not needed here");
  EXPECT_NE(found->chosen.choice.settings.thickness, 0.05f);
}

TEST(Recommendation, FeatureThatHelpsButTakesTooLongIsOverTheBudget) {
  World world{.layer_gain = 0.05, .samples_of_dear_layer = 0.0};
  const auto found = recommend({}, within_ms(1.5), world.functions());
  ASSERT_TRUE(found) << found.error();
  const auto layer =
      std::ranges::find(found->features, "a second depth layer", &FeatureEffect::name);
  ASSERT_NE(layer, found->features.end());
  EXPECT_THAT(layer->sentence(), testing::HasSubstr("5.0 % less error for"));
  EXPECT_THAT(layer->sentence(), testing::EndsWith("more time; over the budget"));
}

TEST(Recommendation, FeatureThatGainsLessThanOnePercentIsNotUsed) {
  for (const auto& [gain, layers] : {std::pair(0.008, 1u), {0.03, 2u}}) {
    World world{gain};
    const auto found = recommend({}, within_ms(1000), world.functions());
    ASSERT_TRUE(found) << found.error();
    EXPECT_EQ(found->chosen.choice.settings.depth_layers, layers) << gain;
  }
}

TEST(Recommendation, FeatureThatFailsIsNamedAndTheOthersAreStillTried) {
  World world;
  RecommendationWorld functions = world.functions();
  const auto rmse = functions.rmse;
  functions.rmse = [&](const Choice& choice) -> Result<std::array<double, 3>> {
    if (passes::needs_back_depth(choice.settings)) return Failure("no back faces");
    return rmse(choice);
  };
  const auto found = recommend({}, within_ms(4), functions);
  ASSERT_TRUE(found) << found.error();
  const auto back = std::ranges::find(
      found->features, "thickness from back faces, whose time differs most between GPUs",
      &FeatureEffect::name);
  ASSERT_NE(back, found->features.end());
  EXPECT_THAT(back->sentence(), testing::HasSubstr("not measured (no back faces)"));
  EXPECT_GT(found->features.size(), 6u);
}

}  // namespace
}  // namespace alcove::sample
