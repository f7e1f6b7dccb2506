// The controller that fits the number of samples to a time.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "alcove/alcove.h"
#include "alcove/passes/setting_table.h"
#include "c/failure.h"

namespace alcove::passes {
namespace {

constexpr std::size_t kFewestTimes = 8;
constexpr std::size_t kMostTimes = 32;
// Settings are raised if the expected time is at most this fraction of the target, and lowered to
// an expected time of at most this fraction.
constexpr double kHeadroom = 0.9;
// A slice without samples costs as much as four steps: its 165 + 2 * 232 instructions over the 2 *
// 75 of a step in both directions (`alcove cost`).
constexpr std::uint32_t kStepsOfASlice = 4;

struct Samples {
  std::uint32_t slices = 0;
  std::uint32_t steps = 0;
  std::uint32_t work() const { return slices * (steps + kStepsOfASlice); }
};

// Calls `visit` for each choice in ascending order of work: all steps of the fewest slices, then of
// one slice more, without choices that take no more work than those before.
template <typename Visit>
void for_each_choice(const AlcoveBudget& budget, const Visit& visit) {
  std::uint32_t before = 0;
  for (Samples choice{budget.least_slices}; choice.slices <= budget.most_slices; ++choice.slices) {
    for (choice.steps = budget.least_steps; choice.steps <= budget.most_steps; ++choice.steps) {
      if (choice.work() > before) {
        before = choice.work();
        visit(choice);
      }
    }
  }
}

// Returns the median of the last times that can be measurements, or 0 if there are too few.
double median_ms(std::span<const double> milliseconds) {
  std::array<double, kMostTimes> times;
  std::size_t count = 0;
  for (auto time = milliseconds.rbegin(); time != milliseconds.rend() && count < kMostTimes; ++time)
    if (std::isfinite(*time) && *time > 0.0) times[count++] = *time;
  if (count < kFewestTimes) return 0.0;
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(times.begin(), middle, times.begin() + static_cast<std::ptrdiff_t>(count));
  return *middle;
}

bool is_usable(const AlcoveBudget& budget) {
  return budget.struct_size == sizeof budget && std::isfinite(budget.target_ms) &&
         budget.target_ms > 0.0 && budget.least_slices >= 1 && budget.most_slices <= 64 &&
         budget.least_slices <= budget.most_slices && budget.least_steps >= 2 &&
         budget.most_steps <= 64 && budget.least_steps <= budget.most_steps;
}

Samples fit(const AlcoveBudget& budget, std::span<const double> milliseconds, const Samples& now) {
  const bool outside = now.slices < budget.least_slices || now.slices > budget.most_slices ||
                       now.steps < budget.least_steps || now.steps > budget.most_steps;
  const double measured = median_ms(milliseconds);
  const double expected_work =
      measured > 0.0 ? kHeadroom * budget.target_ms / measured * now.work() : now.work();
  Samples least{};
  Samples best{};  // that is expected to fit
  Samples nearest{};
  for_each_choice(budget, [&](const Samples& choice) {
    least = least.slices == 0 ? choice : least;
    best = choice.work() <= expected_work ? choice : best;
    nearest = nearest.slices == 0 || choice.work() <= now.work() ? choice : nearest;
  });
  best = best.slices == 0 ? least : best;
  const bool too_slow = measured > budget.target_ms && best.work() < now.work();
  const bool too_fast = measured > 0.0 && best.work() > now.work();
  return too_slow || too_fast ? best : outside ? nearest : now;
}

}  // namespace
}  // namespace alcove::passes

using namespace alcove::passes;

AlcoveResult alcoveFitBudget(const AlcoveBudget* budget, const double* milliseconds, uint32_t count,
                             AlcoveSettings* settings, uint32_t* changed) {
  return guarded([&]() -> Result {
    if (budget == nullptr || settings == nullptr || changed == nullptr ||
        (milliseconds == nullptr && count > 0) || !is_usable(*budget) || !validate(*settings))
      return invalid("");
    const Samples fitted = fit(*budget, {milliseconds, count}, {settings->slices, settings->steps});
    *changed = settings->slices != fitted.slices || settings->steps != fitted.steps ? 1 : 0;
    settings->slices = fitted.slices;
    settings->steps = fitted.steps;
    return {};
  });
}
