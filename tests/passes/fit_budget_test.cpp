// Tests of the controller of samples by simulation with injected times.
#include "alcove/passes/fit_budget.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace alcove::passes {
namespace {

using testing::HasSubstr;

constexpr Budget kBudget{
    .target_ms = 2.0, .least_slices = 1, .most_slices = 2, .least_steps = 4, .most_steps = 16};

// A view whose time is `fixed_ms`, and `ms_per_work` times slices * (steps + 4), times the load of
// the device.
struct Simulation {
  Budget budget = kBudget;
  double fixed_ms = 0.5;
  double ms_per_work = 0.05;
  double scatter = 0.0;  // relative, uniform to both sides
  double load = 1.0;
  OcclusionSettings settings = quality_settings(Quality::low, 1.0f);
  std::mt19937 random{7};
  std::vector<double> times;
  int changes = 0;

  double exact_ms(const OcclusionSettings& of) const {
    return load * (fixed_ms + ms_per_work * of.slices * (of.steps + 4));
  }

  void run(int frames) {
    for (int i = 0; i < frames; ++i) {
      std::uniform_real_distribution<double> around(1.0 - scatter, 1.0 + scatter);
      times.push_back(exact_ms(settings) * around(random));
      const auto fitted = fit_budget(budget, times, settings);
      ASSERT_TRUE(fitted) << fitted.error().message;
      if (!(*fitted == settings)) {
        settings = *fitted;
        times.clear();
        ++changes;
      }
    }
  }
};

bool is_largest(const OcclusionSettings& settings) {
  return settings.slices == kBudget.most_slices && settings.steps == kBudget.most_steps;
}
bool is_least(const OcclusionSettings& settings) {
  return settings.slices == kBudget.least_slices && settings.steps == kBudget.least_steps;
}

TEST(FitBudget, TargetIsApproachedFromBelowWhateverTheFixedShareOfTheTime) {
  for (const double fixed : {0.0, 0.2, 0.5, 0.8, 1.2}) {
    for (const double target : {1.0, 1.5, 2.0, 2.6}) {
      for (const Quality begin : {Quality::console, Quality::low, Quality::medium}) {
        SCOPED_TRACE(testing::Message() << fixed << " ms fixed, target " << target);
        Simulation view{.fixed_ms = fixed, .settings = quality_settings(begin, 1.0f)};
        view.budget.target_ms = target;
        view.run(600);
        const double reached = view.exact_ms(view.settings);
        EXPECT_TRUE(reached <= target || is_least(view.settings)) << reached;
        EXPECT_TRUE(reached >= 0.8 * target || is_largest(view.settings)) << reached;
        EXPECT_LE(view.changes, 12);
      }
    }
  }
}

TEST(FitBudget, TimesThatScatterDoNotChangeTheSettingsBackAndForth) {
  for (const double scatter : {0.02, 0.05, 0.1}) {
    for (unsigned seed = 0; seed < 20; ++seed) {
      SCOPED_TRACE(testing::Message() << "scatter " << scatter << ", seed " << seed);
      Simulation view{.scatter = scatter, .random = std::mt19937(seed)};
      view.run(400);
      const OcclusionSettings settled = view.settings;
      view.changes = 0;
      view.run(1000);
      // A choice at the edge of what is expected to fit may still be raised once.
      EXPECT_LE(view.changes, 1);
      EXPECT_GE(view.exact_ms(view.settings), view.exact_ms(settled));
      EXPECT_LE(view.exact_ms(view.settings), view.budget.target_ms);
    }
  }
}

TEST(FitBudget, SettingsFollowTheLoadOfTheDeviceAndReturn) {
  Simulation view{.scatter = 0.05};
  view.run(300);
  const OcclusionSettings before = view.settings;
  view.load = 1.8;
  view.changes = 0;
  view.run(150);
  EXPECT_LE(view.exact_ms(view.settings), view.budget.target_ms);
  EXPECT_LE(view.changes, 6);
  view.load = 1.0;
  view.run(300);
  EXPECT_LE(view.exact_ms(view.settings), view.budget.target_ms);
  EXPECT_NEAR(view.exact_ms(view.settings), view.exact_ms(before), 0.15 * view.budget.target_ms);
}

TEST(FitBudget, TargetThatCannotBeReachedGivesTheLimitOnce) {
  Simulation slow{.fixed_ms = 5.0, .scatter = 0.1};
  slow.run(1000);
  EXPECT_TRUE(is_least(slow.settings));
  Simulation fast{.fixed_ms = 0.01, .ms_per_work = 1e-4, .scatter = 0.1};
  fast.run(1000);
  EXPECT_TRUE(is_largest(fast.settings));
  for (Simulation* view : {&slow, &fast}) {
    view->changes = 0;
    view->run(1000);
    EXPECT_EQ(view->changes, 0);
  }
}

TEST(FitBudget, NumbersThatAreNoTimesDoNotCount) {
  constexpr double kNoTimes[] = {std::numeric_limits<double>::quiet_NaN(),
                                 0.0,
                                 -1.0,
                                 -0.0,
                                 std::numeric_limits<double>::infinity(),
                                 -std::numeric_limits<double>::infinity()};
  const OcclusionSettings settings = quality_settings(Quality::medium, 1.0f);
  std::vector<double> times;
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(*fit_budget(kBudget, times, settings), settings);
    times.insert(times.end(), std::begin(kNoTimes), std::end(kNoTimes));
  }
  const std::vector<double> seven(7, 9.0);
  EXPECT_EQ(*fit_budget(kBudget, seven, settings), settings) << "too few times";
  const std::vector<double> right(8, 3.0);
  times.insert(times.end(), right.begin(), right.end());
  times.insert(times.end(), std::begin(kNoTimes), std::end(kNoTimes));
  EXPECT_EQ(*fit_budget(kBudget, times, settings), *fit_budget(kBudget, right, settings));
  EXPECT_NE(*fit_budget(kBudget, right, settings), settings);
}

TEST(FitBudget, OnlySlicesAndStepsChangeAndStayWithinTheLimits) {
  for (std::uint32_t most_slices = 1; most_slices <= 3; ++most_slices) {
    for (std::uint32_t steps = 2; steps <= 64; ++steps) {
      OcclusionSettings settings = quality_settings(Quality::console, 0.3f);
      settings.steps = steps;
      for (const double time : {1e-3, 1.0, 1.9, 2.1, 5.0, 1e6}) {
        const Budget budget{2.0, 1, most_slices, 5, 20};
        OcclusionSettings fitted = *fit_budget(budget, std::vector<double>(10, time), settings);
        EXPECT_TRUE(fitted.slices >= 1 && fitted.slices <= most_slices) << fitted.slices;
        EXPECT_TRUE(fitted.steps >= 5 && fitted.steps <= 20) << fitted.steps;
        fitted.slices = settings.slices;
        fitted.steps = settings.steps;
        EXPECT_EQ(fitted, settings);
      }
    }
  }
}

TEST(FitBudget, BudgetThatCannotBeUsedIsReported) {
  const OcclusionSettings settings;
  const auto said = [&](const Budget& budget) {
    const auto fitted = fit_budget(budget, {}, settings);
    return fitted ? std::string() : fitted.error().message;
  };
  for (const double target : {0.0, -1.0, std::nan(""), HUGE_VAL})
    EXPECT_THAT(said({.target_ms = target}), HasSubstr("target")) << target;
  for (const Budget& budget :
       {Budget{1.0, 0, 2, 6, 12}, Budget{1.0, 3, 2, 6, 12}, Budget{1.0, 1, 65, 6, 12},
        Budget{1.0, 1, 2, 1, 12}, Budget{1.0, 1, 2, 13, 12}, Budget{1.0, 1, 2, 6, 65}})
    EXPECT_THAT(said(budget), HasSubstr("limits"));
}

}  // namespace
}  // namespace alcove::passes
