#include "viewer/budget_fitter.h"

namespace alcove::sample {
namespace {

// The first times after a change are those of frames that were in flight, and of a first frame.
constexpr std::uint32_t kFramesInFlight = 4;
constexpr std::size_t kTimes = 32;

double view_ms(const std::vector<PassTime>& times) {
  double sum = 0.0;
  for (const PassTime& time : times)
    if (time.of_view) sum += time.milliseconds;
  return sum;
}

}  // namespace

OcclusionSettings BudgetFitter::fit(const AlcoveBudget& budget, const std::vector<PassTime>& times,
                                    const OcclusionSettings& settings) {
  if (!(settings == settings_)) {
    settings_ = settings;
    milliseconds_.clear();
    frames_ = 0;
  }
  if (++frames_ > kFramesInFlight) {
    if (milliseconds_.size() == kTimes) milliseconds_.erase(milliseconds_.begin());
    milliseconds_.push_back(view_ms(times));
  }
  OcclusionSettings fitted = settings;
  std::uint32_t changed = 0;
  alcoveFitBudget(&budget, milliseconds_.data(), static_cast<std::uint32_t>(milliseconds_.size()),
                  &fitted, &changed);
  return fitted;
}

}  // namespace alcove::sample
