#include "evaluate/recommendation.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "evaluate/sweep.h"

namespace alcove::sample {
namespace {

struct Feature {
  const char* name;
  void (*use)(OcclusionSettings& settings);
};

constexpr Feature kFeatures[] = {
    {"a second depth layer", [](OcclusionSettings& s) { s.depth_layers = 2; }},
    {"thickness from back faces",
     [](OcclusionSettings& s) { s.thickness_unit = ALCOVE_THICKNESS_UNIT_BACK_FACES; }},
    {"a thickness of 0.05", [](OcclusionSettings& s) { s.thickness = 0.05f; }},
    {"a thickness of 0.5", [](OcclusionSettings& s) { s.thickness = 0.5f; }},
    {"a hidden occlusion of 0.1", [](OcclusionSettings& s) { s.hidden_occlusion = 0.1f; }},
    {"a hidden occlusion of 0.7", [](OcclusionSettings& s) { s.hidden_occlusion = 0.7f; }},
    {"horizons, infinitely thick",
     [](OcclusionSettings& s) { s.estimator = ALCOVE_ESTIMATOR_HORIZONS; }},
    {"half resolution", [](OcclusionSettings& s) { s.half_resolution = true; }},
    {"full resolution", [](OcclusionSettings& s) { s.half_resolution = false; }},
    {"a history of twice as many frames",
     [](OcclusionSettings& s) { s.history_frames = std::min(2 * s.history_frames, 64u); }},
    {"no history", [](OcclusionSettings& s) { s.history_frames = 0; }},
};

void copy_samples(const OcclusionSettings& from, OcclusionSettings& settings) {
  settings.tile_size = from.tile_size;
  settings.slices = from.slices;
  settings.steps = from.steps;
  settings.half_resolution = from.half_resolution;
}

double weighted(const std::array<double, 3>& values, const SituationWeights& weights) {
  return std::inner_product(values.begin(), values.end(), weights.begin(), 0.0);
}

// A number of samples, and the time that it takes with the base's features. Modelling a time takes
// seconds, so it is done when the time is needed.
struct Rung {
  OcclusionSettings settings;
  std::optional<double> ms;
};

// The number of samples for each pixel of the image.
double samples_per_pixel(const OcclusionSettings& settings) {
  const double pixels =
      settings.tile_size * settings.tile_size * (settings.half_resolution ? 4 : 1);
  return settings.slices * settings.steps / pixels;
}

class Search {
 public:
  Search(const OcclusionSettings& base, const RecommendationGoal& goal,
         const RecommendationWorld& world)
      : base_(base), goal_(goal), world_(world) {}

  Result<Recommendation> run() {
    for (Variant& variant : preset_sweep(base_)) {
      variant.settings.depth_layers = base_.depth_layers;  // a second depth layer is a feature
      ladder_.push_back({variant.settings, {}});
    }
    std::ranges::stable_sort(ladder_, {},
                             [](const Rung& r) { return samples_per_pixel(r.settings); });
    ALCOVE_TRY_VOID(choose_samples());
    for (const Feature& feature : kFeatures) try_feature(feature);
    if (goal_.tolerance && goal_.met(found_.chosen)) try_with_fewer_samples(found_.chosen.settings);
    refine();
    return std::move(found_);
  }

 private:
  Result<double> time(Rung& rung) const {
    if (!rung.ms) {
      ALCOVE_TRY(const auto ms, world_.time(rung.settings));
      rung.ms = weighted(ms, goal_.weights);
    }
    return *rung.ms;
  }

  // Returns the slowest numbers of samples that take at most `ms`, at most `most` of them. Times
  // nearly rise with the number of samples, so that few of them are modelled.
  Result<std::vector<OcclusionSettings>> slowest_within(double ms, std::size_t most) {
    constexpr std::size_t kOutOfOrder = 2;  // faster ones among those with more samples
    std::size_t low = 0;
    for (std::size_t high = ladder_.size(); low < high;) {
      const std::size_t middle = (low + high) / 2;
      ALCOVE_TRY(const double middle_ms, time(ladder_[middle]));
      (middle_ms <= ms ? low : high) = middle_ms <= ms ? middle + 1 : middle;
    }
    std::vector<OcclusionSettings> found;
    for (std::size_t i = std::min(low + kOutOfOrder, ladder_.size());
         i-- > 0 && found.size() < most;) {
      ALCOVE_TRY(const double rung_ms, time(ladder_[i]));
      if (rung_ms <= ms) found.push_back(ladder_[i].settings);
    }
    return found;
  }

  const Achievement* measured(const OcclusionSettings& settings) const {
    const auto known = std::ranges::find(found_.measured, settings, &Achievement::settings);
    return known == found_.measured.end() ? nullptr : &*known;
  }

  Result<Achievement> measure(const OcclusionSettings& settings) {
    if (const Achievement* known = measured(settings)) return *known;
    auto result = world_.measure(settings);
    if (result) found_.measured.push_back(*result);
    return result;
  }

  // Measures settings and chooses them if the goal prefers them by the margin.
  Result<Achievement> consider(const OcclusionSettings& settings, double margin = 0) {
    auto result = measure(settings);
    if (result && (found_.measured.size() == 1 || goal_.prefers(*result, found_.chosen, margin)))
      found_.chosen = *result;
    return result;
  }

  // Within a budget, considers the numbers of samples that nearly use it up. For a tolerance,
  // considers growing numbers until a few meet it, because the error does not fall with each step.
  Result<void> choose_samples() {
    constexpr std::size_t kWithinBudget = 6;
    constexpr int kWithinTolerance = 2;
    if (goal_.budget_ms) {
      ALCOVE_TRY(auto within, slowest_within(*goal_.budget_ms, kWithinBudget));
      if (within.empty()) within.push_back(ladder_.front().settings);
      for (const OcclusionSettings& settings : within) ALCOVE_TRY_VOID(consider(settings));
      return {};
    }
    int met = 0;
    for (const Rung& rung : ladder_) {
      ALCOVE_TRY(const Achievement result, consider(rung.settings));
      met += goal_.met(result) ? 1 : 0;
      if (met == kWithinTolerance) break;
    }
    return {};
  }

  void try_feature(const Feature& feature) {
    const Achievement before = found_.chosen;
    OcclusionSettings with = before.settings;
    feature.use(with);
    if (with == before.settings || !passes::validate(with)) return;
    const auto result = consider(with, kWorthwhile);
    if (!result) {
      found_.features.push_back({.name = feature.name, .problem = result.error()});
      return;
    }
    FeatureEffect effect = measure_effect(feature.name, goal_, *result, before);
    if (effect.rmse_change < -kWorthwhile) try_with_fewer_samples(with, kWorthwhile);
    OcclusionSettings chosen = found_.chosen.settings;
    feature.use(chosen);
    if (chosen == found_.chosen.settings && chosen != before.settings) effect.verdict = "used";
    found_.features.push_back(std::move(effect));
  }

  // Tries `with` at fewer samples. What a feature adds to the time depends on their number, in
  // steps where the search exceeds a cache, so that more numbers are modelled than measured.
  void try_with_fewer_samples(const OcclusionSettings& with, double margin = 0) {
    const std::size_t most = goal_.budget_ms ? 4 : 8;
    const double limit = goal_.budget_ms ? *goal_.budget_ms : goal_.ms(found_.chosen);
    const auto within = slowest_within(limit, ladder_.size());
    if (!within) return;
    std::size_t count = 0;
    for (const OcclusionSettings& samples : *within) {
      OcclusionSettings fewer = with;
      copy_samples(samples, fewer);
      count += consider_if_promising(fewer, margin) ? 1 : 0;
      if (count == most) return;
    }
  }

  // Measures settings only if their time does not rule them out, and returns whether it did.
  // Settings that fail are left out.
  bool consider_if_promising(const OcclusionSettings& settings, double margin = 0) {
    if (!passes::validate(settings) || measured(settings) != nullptr) return false;
    const auto times = world_.time(settings);
    if (!times) return false;
    const double ms = weighted(*times, goal_.weights);
    const double limit = goal_.budget_ms ? *goal_.budget_ms : goal_.ms(found_.chosen);
    return (!goal_.met(found_.chosen) || ms <= limit) && consider(settings, margin).has_value();
  }

  // Changes one number of samples at a time, as long as that helps.
  void refine() {
    constexpr int kRounds = 3;
    for (int round = 0; round < kRounds; ++round) {
      const Achievement before = found_.chosen;
      const OcclusionSettings& from = before.settings;
      // A tenth of a frame at least is the search, whose time is proportional to the samples. More
      // samples that exceed the limit even so are left out without modelling their time.
      const double limit = goal_.budget_ms ? *goal_.budget_ms : goal_.ms(before);
      const auto change = [&](auto OcclusionSettings::*field, auto value) {
        OcclusionSettings changed = from;
        changed.*field = value;
        const double more = samples_per_pixel(changed) / samples_per_pixel(from) - 1.0;
        const bool too_slow = more > 0 && goal_.ms(before) * (1.0 + 0.1 * more) > limit;
        if (!goal_.met(before) || !too_slow) consider_if_promising(changed);
      };
      for (const std::uint32_t steps :
           {from.steps * 3 / 4, from.steps - 1, from.steps + 1, (from.steps * 4 + 2) / 3})
        change(&OcclusionSettings::steps, steps);
      change(&OcclusionSettings::slices, from.slices - 1);
      change(&OcclusionSettings::slices, from.slices + 1);
      change(&OcclusionSettings::tile_size, from.tile_size / 2);
      change(&OcclusionSettings::tile_size, from.tile_size * 2);
      if (found_.chosen.settings == from) return;
    }
  }

  OcclusionSettings base_;
  const RecommendationGoal& goal_;
  const RecommendationWorld& world_;
  std::vector<Rung> ladder_;
  Recommendation found_;
};

}  // namespace

double RecommendationGoal::rmse(const Achievement& of) const { return weighted(of.rmse, weights); }

double RecommendationGoal::ms(const Achievement& of) const { return weighted(of.ms, weights); }

bool RecommendationGoal::met(const Achievement& by) const {
  return budget_ms ? ms(by) <= *budget_ms : rmse(by) <= *tolerance;
}

bool RecommendationGoal::prefers(const Achievement& a, const Achievement& b, double margin) const {
  if (met(a) != met(b)) return met(a);
  const bool by_error = budget_ms.has_value() == met(a);
  return by_error ? rmse(a) < (1 - margin) * rmse(b) : ms(a) < (1 - margin) * ms(b);
}

std::string FeatureEffect::sentence() const {
  if (!problem.empty()) return fmt::format("{}: not measured ({})", name, problem);
  const auto change = [](double relative, const char* quantity) {
    const double per_cent = 100.0 * std::abs(relative);
    return per_cent < 0.05
               ? fmt::format("no difference in {}", quantity)
               : fmt::format("{:.1f} % {} {}", per_cent, relative < 0 ? "less" : "more", quantity);
  };
  return fmt::format("{}: {} for {}; {}", name, change(rmse_change, "error"),
                     change(ms_change, "time"), verdict);
}

FeatureEffect measure_effect(const std::string& feature, const RecommendationGoal& goal,
                             const Achievement& with, const Achievement& without) {
  FeatureEffect effect{feature, goal.rmse(with) / goal.rmse(without) - 1.0,
                       goal.ms(with) / goal.ms(without) - 1.0};
  if (effect.rmse_change < -kWorthwhile && goal.budget_ms && !goal.met(with))
    effect.verdict = "over the budget";
  return effect;
}

Result<Recommendation> recommend(const OcclusionSettings& base, const RecommendationGoal& goal,
                                 const RecommendationWorld& world) {
  return Search(base, goal, world).run();
}

}  // namespace alcove::sample
