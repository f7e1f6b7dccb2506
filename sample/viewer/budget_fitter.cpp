#include "viewer/budget_fitter.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace alcove::sample {
namespace {

// The passes of which a view consists; the window also draws the scene and the panel.
constexpr std::array<std::string_view, 7> kOcclusionPasses{
    "gtao",         "reconstruct",        "upsample",    "half-resolution output",
    "linear depth", "specular occlusion", "multi-bounce"};

// The first times after a change are those of frames that were in flight, and of a first frame.
constexpr std::uint32_t kFramesInFlight = 4;
constexpr std::size_t kTimes = 32;

double occlusion_ms(const std::vector<PassTime>& times) {
  double sum = 0.0;
  for (const PassTime& time : times)
    if (std::ranges::find(kOcclusionPasses, time.pass) != kOcclusionPasses.end())
      sum += time.milliseconds;
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
    milliseconds_.push_back(occlusion_ms(times));
  }
  OcclusionSettings fitted = settings;
  std::uint32_t changed = 0;
  alcoveFitBudget(&budget, milliseconds_.data(), static_cast<std::uint32_t>(milliseconds_.size()),
                  &fitted, &changed);
  return fitted;
}

}  // namespace alcove::sample
