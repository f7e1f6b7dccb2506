// Tests of the controller of samples by simulation with injected times.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "alcove/alcove.h"

namespace alcove::passes {
namespace {

constexpr AlcoveBudget kBudget{.struct_size = sizeof(AlcoveBudget),
                               .target_ms = 2.0,
                               .least_slices = 1,
                               .most_slices = 2,
                               .least_steps = 4,
                               .most_steps = 16};

AlcoveSettings settings_of(AlcoveQuality quality) {
  AlcoveSettings settings{.struct_size = sizeof settings};
  EXPECT_EQ(alcoveGetSettings(quality, 1.0f, &settings), ALCOVE_SUCCESS);
  return settings;
}

// A view whose time is `fixed_ms`, and `ms_per_work` times slices * (steps + 4), times the load of
// the device.
struct Simulation {
  AlcoveBudget budget = kBudget;
  double fixed_ms = 0.5;
  double ms_per_work = 0.05;
  double scatter = 0.0;  // relative, uniform to both sides
  double load = 1.0;
  AlcoveSettings settings = settings_of(ALCOVE_QUALITY_LOW);
  std::mt19937 random{7};
  std::vector<double> times;
  int changes = 0;

  double exact_ms(const AlcoveSettings& of) const {
    return load * (fixed_ms + ms_per_work * of.slices * (of.steps + 4));
  }

  void run(int frames) {
    for (int i = 0; i < frames; ++i) {
      std::uniform_real_distribution<double> around(1.0 - scatter, 1.0 + scatter);
      times.push_back(exact_ms(settings) * around(random));
      std::uint32_t changed = 0;
      ASSERT_EQ(alcoveFitBudget(&budget, times.data(), static_cast<std::uint32_t>(times.size()),
                                &settings, &changed),
                ALCOVE_SUCCESS);
      if (changed != 0) times.clear();
      changes += static_cast<int>(changed);
    }
  }
};

using Samples = std::pair<std::uint32_t, std::uint32_t>;  // slices and steps

Samples samples_of(const AlcoveSettings& settings) { return {settings.slices, settings.steps}; }

Samples fit_samples(const AlcoveBudget& budget, const std::vector<double>& times,
                    AlcoveSettings settings) {
  std::uint32_t changed = 0;
  EXPECT_EQ(alcoveFitBudget(&budget, times.data(), static_cast<std::uint32_t>(times.size()),
                            &settings, &changed),
            ALCOVE_SUCCESS);
  return samples_of(settings);
}

bool is_largest(const AlcoveSettings& settings) {
  return settings.slices == kBudget.most_slices && settings.steps == kBudget.most_steps;
}
bool is_least(const AlcoveSettings& settings) {
  return settings.slices == kBudget.least_slices && settings.steps == kBudget.least_steps;
}

TEST(FitBudget, TargetIsApproachedFromBelowWhateverTheFixedShareOfTheTime) {
  for (const double fixed : {0.0, 0.2, 0.5, 0.8, 1.2}) {
    for (const double target : {1.0, 1.5, 2.0, 2.6}) {
      for (const AlcoveQuality begin :
           {ALCOVE_QUALITY_CONSOLE, ALCOVE_QUALITY_LOW, ALCOVE_QUALITY_MEDIUM}) {
        SCOPED_TRACE(testing::Message() << fixed << " ms fixed, target " << target);
        Simulation view{.fixed_ms = fixed, .settings = settings_of(begin)};
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
      const AlcoveSettings before = view.settings;
      view.changes = 0;
      view.run(1000);
      // A choice at the edge of what is expected to fit may still be raised once.
      EXPECT_LE(view.changes, 1);
      EXPECT_GE(view.exact_ms(view.settings), view.exact_ms(before));
      EXPECT_LE(view.exact_ms(view.settings), view.budget.target_ms);
    }
  }
}

TEST(FitBudget, SettingsFollowTheLoadOfTheDeviceAndReturn) {
  Simulation view{.scatter = 0.05};
  view.run(300);
  const AlcoveSettings before = view.settings;
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
  const AlcoveSettings settings = settings_of(ALCOVE_QUALITY_LOW);
  std::vector<double> times;
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(fit_samples(kBudget, times, settings), samples_of(settings));
    times.insert(times.end(), std::begin(kNoTimes), std::end(kNoTimes));
  }
  const std::vector<double> seven(7, 9.0);
  EXPECT_EQ(fit_samples(kBudget, seven, settings), samples_of(settings)) << "too few times";
  const std::vector<double> eight(8, 3.0);
  times.insert(times.end(), eight.begin(), eight.end());
  times.insert(times.end(), std::begin(kNoTimes), std::end(kNoTimes));
  EXPECT_EQ(fit_samples(kBudget, times, settings), fit_samples(kBudget, eight, settings));
  EXPECT_NE(fit_samples(kBudget, eight, settings), samples_of(settings));
}

TEST(FitBudget, SlicesAndStepsStayWithinTheLimits) {
  for (std::uint32_t most_slices = 1; most_slices <= 3; ++most_slices) {
    for (std::uint32_t steps = 2; steps <= 64; ++steps) {
      AlcoveSettings settings = settings_of(ALCOVE_QUALITY_LOW);
      settings.steps = steps;
      for (const double time : {1e-3, 1.0, 1.9, 2.1, 5.0, 1e6}) {
        const AlcoveBudget budget{sizeof budget, 2.0, 1, most_slices, 5, 20};
        const auto [slices, steps_now] =
            fit_samples(budget, std::vector<double>(10, time), settings);
        EXPECT_TRUE(slices >= 1 && slices <= most_slices) << slices;
        EXPECT_TRUE(steps_now >= 5 && steps_now <= 20) << steps_now;
      }
    }
  }
}

TEST(FitBudget, ArgumentsThatCannotBeUsedAreErrors) {
  const auto fit = [](const AlcoveBudget& budget) {
    AlcoveSettings settings = settings_of(ALCOVE_QUALITY_LOW);
    std::uint32_t changed = 0;
    return alcoveFitBudget(&budget, nullptr, 0, &settings, &changed);
  };
  constexpr std::uint32_t kSize = sizeof(AlcoveBudget);
  EXPECT_EQ(fit({kSize, 1.0, 1, 2, 6, 12}), ALCOVE_SUCCESS);
  for (const double target : {0.0, -1.0, std::nan(""), HUGE_VAL})
    EXPECT_EQ(fit({kSize, target, 1, 2, 6, 12}), ALCOVE_ERROR_INVALID_INPUT) << target;
  for (const AlcoveBudget& budget :
       {AlcoveBudget{4, 1.0, 1, 2, 6, 12}, AlcoveBudget{kSize, 1.0, 0, 2, 6, 12},
        AlcoveBudget{kSize, 1.0, 3, 2, 6, 12}, AlcoveBudget{kSize, 1.0, 1, 65, 6, 12},
        AlcoveBudget{kSize, 1.0, 1, 2, 1, 12}, AlcoveBudget{kSize, 1.0, 1, 2, 13, 12},
        AlcoveBudget{kSize, 1.0, 1, 2, 6, 65}})
    EXPECT_EQ(fit(budget), ALCOVE_ERROR_INVALID_INPUT);
  AlcoveSettings settings = settings_of(ALCOVE_QUALITY_LOW);
  std::uint32_t changed = 0;
  const AlcoveResult error = ALCOVE_ERROR_INVALID_INPUT;
  EXPECT_EQ(alcoveFitBudget(nullptr, nullptr, 0, &settings, &changed), error);
  EXPECT_EQ(alcoveFitBudget(&kBudget, nullptr, 1, &settings, &changed), error);
  EXPECT_EQ(alcoveFitBudget(&kBudget, nullptr, 0, nullptr, &changed), error);
  EXPECT_EQ(alcoveFitBudget(&kBudget, nullptr, 0, &settings, nullptr), error);
}

}  // namespace
}  // namespace alcove::passes
