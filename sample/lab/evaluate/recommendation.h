// The choice of settings for a view, from a list of numbers of samples and of features.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/occlusion.h"
#include "support/progress.h"
#include "support/result.h"

namespace alcove::sample {

// The situations in which error and time differ. Names are in the order of the enumerators.
enum class Situation { first, moving, standing };
inline constexpr std::array<std::string_view, 3> kSituationNames{"first", "moving", "standing"};

// One choice of a search.
struct Choice {
  OcclusionSettings settings;
  // Width of the part beyond each border of the image that is rendered and not displayed
  // (AlcoveView::written_area), in percent of the height.
  double guard_band = 0.0;

  bool operator==(const Choice&) const = default;
};

// The result of a choice: the RMSE of visibility against scene truth, and the time of the occlusion
// passes in milliseconds, in each situation.
struct Achievement {
  Choice choice;
  std::array<double, 3> rmse{};
  std::array<double, 3> ms{};
};

// How much each situation counts; the sum is 1. By default mostly the moving camera.
using SituationWeights = std::array<double, 3>;
inline constexpr SituationWeights kMixedWeights{0.1, 0.6, 0.3};

// The limit that the settings have to meet. Exactly one of the two is given.
struct RecommendationGoal {
  std::optional<double> budget_ms;
  std::optional<double> tolerance;  // RMSE
  SituationWeights weights = kMixedWeights;

  double rmse(const Achievement& of) const;
  double ms(const Achievement& of) const;
  bool met(const Achievement& by) const;
};

// The effect of one feature at otherwise equal settings.
struct FeatureEffect {
  std::string name;
  double rmse_change = 0;  // relative: -0.2 for 20 % less
  double ms_change = 0;
  std::string verdict = "not needed here";
  bool timed = true;    // whether ms_change is known
  std::string problem;  // an error if the feature could not be measured; empty otherwise

  std::string sentence() const;
};

struct Recommendation {
  std::vector<FeatureEffect> features;
  // The measured choices that err less than all faster ones, from fast to slow. At least one.
  std::vector<Achievement> front;

  const Achievement& chosen() const { return front.back(); }
};

// Functions that a search calls: the values of Achievement::rmse and ms, and how much is done.
struct RecommendationWorld {
  std::function<Result<std::array<double, 3>>(const Choice&)> rmse;
  std::function<Result<std::array<double, 3>>(const Choice&)> ms;
  Progress progress = {};
  // Whether the host draws these depths, and `ms` contains their time. If not, they are only in the
  // answer if the base has them.
  bool second_layer = false, back_faces = false;
};

// Searches from `base`, whose settings beyond those that the search changes are kept. Features are
// measured at few samples per pixel. Then the settings of preset_sweep() with up to 12 samples per
// pixel, with and without each feature that is worthwhile, are sorted by their times and measured
// from fast to slow, until one meets the tolerance or exceeds the budget. The answers by budget and
// by tolerance are therefore from one list. If nothing meets the goal, the result is the closest.
// Errors: those of the world's functions, except for features, which say so themselves.
[[nodiscard]] Result<Recommendation> recommend(const Choice& base, const RecommendationGoal& goal,
                                               const RecommendationWorld& world);

}  // namespace alcove::sample
