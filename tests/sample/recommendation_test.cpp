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
              const double error = rmse(choice.settings);
              return std::array{1.2 * error, error, 0.9 * error};
            },
            [this](const Choice& choice) -> Result<std::array<double, 3>> {
              ++models;
              const double time = ms(choice.settings);
              return std::array{time, time, 0.9 * time};
            },
            {},
            true,
            true};
  }
};

RecommendationGoal within_ms(double ms) { return {ms, std::nullopt}; }
RecommendationGoal within_rmse(double rmse) { return {std::nullopt, rmse}; }

Recommendation search(const RecommendationGoal& goal, const RecommendationWorld& world) {
  const auto found = recommend({}, goal, world);
  EXPECT_TRUE(found) << found.error();
  return *found;
}

FeatureEffect effect(const Recommendation& found, const std::string& name) {
  const auto effect = std::ranges::find(found.features, name, &FeatureEffect::name);
  EXPECT_NE(effect, found.features.end());
  return *effect;
}

// Whether `a` answers the goal better than `b`.
bool is_better(const RecommendationGoal& goal, const Achievement& a, const Achievement& b) {
  if (goal.met(a) != goal.met(b)) return goal.met(a);
  const bool by_error = goal.budget_ms.has_value() == goal.met(a);
  return by_error ? goal.rmse(a) < goal.rmse(b) : goal.ms(a) < goal.ms(b);
}

// The best of every number of samples with and without a second layer.
Achievement best_of_all(const RecommendationGoal& goal, World world) {
  std::optional<Achievement> best;
  const auto functions = world.functions();
  for (const Variant& variant : preset_sweep({})) {
    for (const std::uint32_t layers : {1u, 2u}) {
      Achievement found{{variant.settings}};
      found.choice.settings.depth_layers = layers;
      if (World::samples(found.choice.settings) > 12.0) continue;
      found.rmse = functions.rmse(found.choice).value();
      found.ms = functions.ms(found.choice).value();
      if (!best || is_better(goal, found, *best)) best = found;
    }
  }
  return *best;
}

// The time of a second layer rises in steps where the search exceeds a cache. The answer to an
// impossible goal is the closest.
TEST(Recommendation, BudgetIsMetWithTheErrorOfABruteForceSearch) {
  for (const double gain : {0.0, 0.15, 0.2, 0.5}) {
    for (const double samples : {0.2, 0.6, 1e9}) {
      for (const double ms : {0.1, 0.5, 0.7, 0.9, 1.3, 1.8, 2.2, 3.0, 6.0, 40.0}) {
        World world{gain, samples};
        const RecommendationGoal goal = within_ms(ms);
        const Recommendation found = search(goal, world.functions());
        EXPECT_EQ(goal.met(found.chosen()), ms > 0.4) << ms;
        EXPECT_LE(goal.rmse(found.chosen()), (1.0 + 1e-9) * goal.rmse(best_of_all(goal, world)))
            << gain << " " << samples << " " << ms;
        EXPECT_LE(world.renders, 40) << ms;
        EXPECT_LE(world.models, 35) << ms;
      }
    }
  }
}

TEST(Recommendation, ToleranceIsMetInTheTimeOfABruteForceSearch) {
  for (const double gain : {0.0, 0.2}) {
    for (const double rmse : {0.09, 0.06, 0.05, 0.048, 0.037, 0.001}) {
      World world{gain};
      const RecommendationGoal goal = within_rmse(rmse);
      const Recommendation found = search(goal, world.functions());
      EXPECT_EQ(goal.met(found.chosen()), rmse > (gain > 0.0 ? 0.0369 : 0.046)) << rmse;
      EXPECT_LE(goal.ms(found.chosen()), (1.0 + 1e-9) * goal.ms(best_of_all(goal, world))) << rmse;
    }
  }
}

// The error that a budget buys is reached again, in the same time, if it is the tolerance.
TEST(Recommendation, AnswersByBudgetAndByToleranceAgree) {
  World world{.layer_gain = 0.15, .samples_of_dear_layer = 0.4};
  for (double ms = 0.4; ms < 6.0; ms += 0.1) {
    const RecommendationGoal budget = within_ms(ms);
    const Recommendation by_budget = search(budget, world.functions());
    const Recommendation by_tolerance =
        search(within_rmse(budget.rmse(by_budget.chosen())), world.functions());
    EXPECT_EQ(by_tolerance.chosen().choice, by_budget.chosen().choice) << ms;
  }
}

// A feature that only the host can give is measured, and used only if the host says that it has it.
TEST(Recommendation, FeatureOfTheHostIsOnlyUsedIfTheHostHasIt) {
  World world{.layer_gain = 0.5};
  RecommendationWorld functions = world.functions();
  functions.second_layer = false;
  const Recommendation found = search(within_ms(100), functions);
  EXPECT_EQ(found.chosen().choice.settings.depth_layers, 1u);
  const FeatureEffect layer = effect(found, "a second depth layer");
  EXPECT_EQ(layer.sentence(),
            "a second depth layer: 50.0 % less error; only considered with --second-layer MS, the "
            "time of drawing it");
  EXPECT_EQ(found.chosen().choice.guard_band, 0.0);
}

TEST(Recommendation, EachFeatureHasASentenceAboutItsErrorAndTime) {
  World world;
  const Recommendation found = search(within_ms(4), world.functions());
  const FeatureEffect layer = effect(found, "a second depth layer");
  EXPECT_THAT(layer.sentence(), testing::StartsWith("a second depth layer: 20.0 % less error for"));
  EXPECT_THAT(layer.sentence(), testing::HasSubstr("more time; used"));
  // Thickness changes nothing in this world, so it is not chosen.
  const FeatureEffect thickness = effect(found, "a thickness of 0.05");
  EXPECT_EQ(
      thickness.sentence(),
      "a thickness of 0.05: no difference in error for no difference in time; not needed here");
  EXPECT_NE(found.chosen().choice.settings.thickness, 0.05f);
}

TEST(Recommendation, FeatureThatGainsLessThanOnePercentIsNotUsed) {
  for (const auto& [gain, layers] : {std::pair(0.008, 1u), {0.03, 2u}}) {
    World world{gain};
    const Recommendation found = search(within_ms(1000), world.functions());
    EXPECT_EQ(found.chosen().choice.settings.depth_layers, layers) << gain;
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
  const Recommendation found = search(within_ms(4), functions);
  const FeatureEffect back =
      effect(found, "thickness from back faces, whose time differs most between GPUs");
  EXPECT_THAT(back.sentence(), testing::HasSubstr("not measured (no back faces)"));
  EXPECT_GT(found.features.size(), 6u);
}

}  // namespace
}  // namespace alcove::sample
