#include "evaluate/recommendation.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "evaluate/trade.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;
using passes::OcclusionSettings;

// A smaller relative change of the error is not worth a feature.
constexpr double kWorthwhile = 0.01;

struct Feature {
  const char* name;
  void (*use)(OcclusionSettings& settings);
};

constexpr Feature kFeatures[] = {
    {"a second depth layer", [](OcclusionSettings& s) { s.depth_layers = 2; }},
    {"thickness from back faces",
     [](OcclusionSettings& s) { s.advanced.thickness_unit = passes::ThicknessUnit::back_faces; }},
    {"a thickness of 0.05", [](OcclusionSettings& s) { s.thickness = 0.05f; }},
    {"a thickness of 0.5", [](OcclusionSettings& s) { s.thickness = 0.5f; }},
    {"a hidden occlusion of 0.1", [](OcclusionSettings& s) { s.hidden_occlusion = 0.1f; }},
    {"a hidden occlusion of 0.7", [](OcclusionSettings& s) { s.hidden_occlusion = 0.7f; }},
    {"unobserved directions that count as open",
     [](OcclusionSettings& s) { s.advanced.unobserved = false; }},
    {"horizons, infinitely thick",
     [](OcclusionSettings& s) { s.advanced.estimator = passes::Estimator::horizons; }},
    {"half resolution", [](OcclusionSettings& s) { s.half_resolution = true; }},
    {"full resolution", [](OcclusionSettings& s) { s.half_resolution = false; }},
    {"a history of twice as many frames",
     [](OcclusionSettings& s) { s.history_frames = std::min(2 * s.history_frames, 64u); }},
    {"no history", [](OcclusionSettings& s) { s.history_frames = 0; }},
};

void use_samples_of(const OcclusionSettings& from, OcclusionSettings& settings) {
  settings.tile_size = from.tile_size;
  settings.slices = from.slices;
  settings.steps = from.steps;
  settings.half_resolution = from.half_resolution;
}

double weighted(const std::array<double, 3>& values, const SituationWeights& weights) {
  return std::inner_product(values.begin(), values.end(), weights.begin(), 0.0);
}

// A number of samples, and the time that it takes with the base's features.
struct Rung {
  OcclusionSettings settings;
  double ms = 0;
};

class Search {
 public:
  Search(const OcclusionSettings& base, const RecommendationGoal& goal,
         const RecommendationWorld& world)
      : base_(base), goal_(goal), world_(world) {}

  tl::expected<Recommendation, std::string> run() {
    if (auto made = make_ladder(); !made) {
      return Failure(std::move(made.error()));
    }
    if (auto chosen = choose_samples(); !chosen) {
      return Failure(std::move(chosen.error()));
    }
    for (const Feature& feature : kFeatures) {
      try_feature(feature);
    }
    if (goal_.tolerance && goal_.met(found_.chosen)) {
      try_with_fewer_samples(found_.chosen.settings, 1.0);
    }
    refine();
    return std::move(found_);
  }

 private:
  // Every number of samples in order of time. A second depth layer is a feature.
  tl::expected<void, std::string> make_ladder() {
    for (Variant& variant : preset_sweep(base_)) {
      variant.settings.depth_layers = base_.depth_layers;
      const auto ms = world_.time(variant.settings);
      if (!ms) {
        return Failure(ms.error());
      }
      ladder_.push_back({variant.settings, weighted(*ms, goal_.weights)});
    }
    std::ranges::stable_sort(ladder_, {}, &Rung::ms);
    return {};
  }

  const Achievement* measured(const OcclusionSettings& settings) const {
    const auto known = std::ranges::find(found_.measured, settings, &Achievement::settings);
    return known == found_.measured.end() ? nullptr : &*known;
  }

  tl::expected<Achievement, std::string> measure(const OcclusionSettings& settings) {
    if (const Achievement* known = measured(settings)) {
      return *known;
    }
    auto result = world_.measure(settings);
    if (result) {
      found_.measured.push_back(*result);
    }
    return result;
  }

  // Measures settings and chooses them if the goal prefers them.
  tl::expected<Achievement, std::string> consider(const OcclusionSettings& settings) {
    auto result = measure(settings);
    if (result && (found_.measured.size() == 1 || goal_.prefers(*result, found_.chosen))) {
      found_.chosen = *result;
    }
    return result;
  }

  // Within a budget, the numbers of samples that nearly use it up. For a tolerance, those in order
  // of time until a few meet it: the error does not fall with each step.
  tl::expected<void, std::string> choose_samples() {
    constexpr std::size_t kWithinBudget = 6;
    constexpr int kWithinTolerance = 2;
    if (goal_.budget_ms) {
      auto last = std::ranges::partition_point(
          ladder_, [&](const Rung& rung) { return rung.ms <= *goal_.budget_ms; });
      last = last == ladder_.begin() ? last + 1 : last;
      const auto count = std::min<std::ptrdiff_t>(last - ladder_.begin(), kWithinBudget);
      for (auto rung = last - count; rung != last; ++rung) {
        if (auto result = consider(rung->settings); !result) {
          return Failure(std::move(result.error()));
        }
      }
      return {};
    }
    int met = 0;
    for (const Rung& rung : ladder_) {
      const auto result = consider(rung.settings);
      if (!result) {
        return Failure(result.error());
      }
      met += goal_.met(*result) ? 1 : 0;
      if (met == kWithinTolerance) {
        break;
      }
    }
    return {};
  }

  void try_feature(const Feature& feature) {
    const Achievement before = found_.chosen;
    OcclusionSettings with = before.settings;
    feature.use(with);
    if (with == before.settings || !passes::validate(with)) {
      return;
    }
    FeatureEffect effect{feature.name};
    const auto result = consider(with);
    if (!result) {
      effect.problem = result.error();
      found_.features.push_back(std::move(effect));
      return;
    }
    effect.rmse_change = goal_.rmse(*result) / goal_.rmse(before) - 1.0;
    effect.ms_change = goal_.ms(*result) / goal_.ms(before) - 1.0;
    if (effect.rmse_change < -kWorthwhile) {
      try_with_fewer_samples(with, 1.0 + effect.ms_change);
    }
    OcclusionSettings chosen = found_.chosen.settings;
    feature.use(chosen);
    effect.chosen = chosen == found_.chosen.settings && found_.chosen.settings != before.settings;
    found_.features.push_back(std::move(effect));
  }

  // Tries `with` at numbers of samples that take less time. `ratio` is the time with the feature
  // over that without.
  void try_with_fewer_samples(const OcclusionSettings& with, double ratio) {
    const std::size_t most = goal_.budget_ms ? 4 : 8;
    std::size_t tried = 0;
    for (auto rung = ladder_.rbegin(); rung != ladder_.rend() && tried < most; ++rung) {
      const double limit =
          goal_.budget_ms ? *goal_.budget_ms / ratio : goal_.ms(found_.chosen) / ratio;
      if (rung->ms > limit) {
        continue;
      }
      OcclusionSettings fewer = with;
      use_samples_of(rung->settings, fewer);
      ++tried;
      consider_if_promising(fewer);
    }
  }

  // Measures settings only if their time does not rule them out. Settings that fail are left out.
  void consider_if_promising(const OcclusionSettings& settings) {
    if (!passes::validate(settings) || measured(settings) != nullptr) {
      return;
    }
    const auto times = world_.time(settings);
    if (!times) {
      return;
    }
    const double ms = weighted(*times, goal_.weights);
    const double limit = goal_.budget_ms ? *goal_.budget_ms : goal_.ms(found_.chosen);
    if (!goal_.met(found_.chosen) || ms <= limit) {
      (void)consider(settings);
    }
  }

  // Changes one number of samples at a time, as long as that helps.
  void refine() {
    constexpr int kRounds = 3;
    for (int round = 0; round < kRounds; ++round) {
      const OcclusionSettings from = found_.chosen.settings;
      const auto change = [&](auto OcclusionSettings::*field, auto value) {
        OcclusionSettings changed = from;
        changed.*field = value;
        consider_if_promising(changed);
      };
      for (const std::uint32_t steps :
           {from.steps * 3 / 4, from.steps - 1, from.steps + 1, (from.steps * 4 + 2) / 3}) {
        change(&OcclusionSettings::steps, steps);
      }
      change(&OcclusionSettings::slices, from.slices - 1);
      change(&OcclusionSettings::slices, from.slices + 1);
      change(&OcclusionSettings::tile_size, from.tile_size / 2);
      change(&OcclusionSettings::tile_size, from.tile_size * 2);
      if (found_.chosen.settings == from) {
        return;
      }
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

bool RecommendationGoal::prefers(const Achievement& a, const Achievement& b) const {
  if (met(a) != met(b)) {
    return met(a);
  }
  const bool by_error = budget_ms.has_value() == met(a);
  return by_error ? rmse(a) < rmse(b) : ms(a) < ms(b);
}

std::string FeatureEffect::sentence() const {
  if (!problem.empty()) {
    return fmt::format("{}: not measured ({})", name, problem);
  }
  const auto change = [](double relative, const char* less, const char* more) {
    return fmt::format("{:.1f} % {}", 100.0 * std::abs(relative), relative < 0 ? less : more);
  };
  return fmt::format("{}: {} for {}; {}", name, change(rmse_change, "less error", "more error"),
                     change(ms_change, "less time", "more time"),
                     chosen ? "used" : "not needed here");
}

tl::expected<Recommendation, std::string> recommend(const OcclusionSettings& base,
                                                    const RecommendationGoal& goal,
                                                    const RecommendationWorld& world) {
  return Search(base, goal, world).run();
}

tl::expected<std::vector<Achievement>, std::string> measure_all(const OcclusionSettings& base,
                                                                const RecommendationWorld& world) {
  std::vector<Achievement> all;
  for (const Variant& variant : preset_sweep(base)) {
    for (const std::uint32_t layers : {1u, 2u}) {
      OcclusionSettings settings = variant.settings;
      settings.depth_layers = layers;
      const auto measured = world.measure(settings);
      if (!measured) {
        return Failure(measured.error());
      }
      all.push_back(*measured);
    }
  }
  return all;
}

}  // namespace alcove::sample
