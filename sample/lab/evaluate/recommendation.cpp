#include "evaluate/recommendation.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "alcove/passes/setting_table.h"
#include "evaluate/sweep.h"

namespace alcove::sample {
namespace {

// A feature is not used unless it lowers the error, or the time at the same error, by more than
// this fraction.
constexpr double kWorthwhile = 0.01;

using Values = std::array<double, 3>;  // by Situation

struct Feature {
  const char* name;
  void (*use)(Choice& choice);
  bool takes_time = true;  // the others are parameters of the shaders
  // The option that says that the host has what the feature needs, and whether it does.
  const char* option = nullptr;
  bool RecommendationWorld::*available = nullptr;
};

// The width of a guard band in percent of the image's height: about the length of a search.
constexpr double kGuardBand = 10.0;

constexpr Feature kFeatures[] = {
    {"a thickness of 0.05", [](Choice& c) { c.settings.thickness = 0.05f; }, false},
    {"a thickness of 0.5", [](Choice& c) { c.settings.thickness = 0.5f; }, false},
    {"a hidden occlusion of 0.1", [](Choice& c) { c.settings.hidden_occlusion = 0.1f; }, false},
    {"a hidden occlusion of 0.7", [](Choice& c) { c.settings.hidden_occlusion = 0.7f; }, false},
    {"no history", [](Choice& c) { c.settings.history_frames = 0; }},
    {"a second depth layer", [](Choice& c) { c.settings.depth_layers = 2; }, true,
     "--second-layer MS, the time of drawing it", &RecommendationWorld::second_layer},
    {"thickness from back faces, whose time differs most between GPUs",
     [](Choice& c) { c.settings.thickness_limit = ALCOVE_THICKNESS_LIMIT_BACK_FACES; }, true,
     "--back-faces MS, the time of drawing them", &RecommendationWorld::back_faces},
    {"a guard band of 10 % of the height",
     [](Choice& c) { c.guard_band = std::max(c.guard_band, kGuardBand); }, true,
     "--guard-band 10, which the engine has to draw"},
};

// The number of samples for each pixel of the image.
double samples_per_pixel(const OcclusionSettings& settings) {
  const double pixels =
      settings.tile_size * settings.tile_size * (settings.half_resolution ? 4 : 1);
  return settings.slices * settings.steps / pixels;
}

double weighted(const Values& values, const SituationWeights& weights) {
  return std::inner_product(values.begin(), values.end(), weights.begin(), 0.0);
}

class Search {
 public:
  Search(const Choice& base, const RecommendationGoal& goal, const RecommendationWorld& world)
      : base_(base), goal_(goal), world_(world) {
    constexpr double kMost = 12.0;  // more samples per pixel take longer than frames in real time
    for (const Variant& variant : preset_sweep(base.settings))
      if (samples_per_pixel(variant.settings) <= kMost) samples_.push_back(variant.settings);
  }

  Result<Recommendation> run() {
    ALCOVE_TRY(const auto variants, try_features());
    ALCOVE_TRY(auto list, timed_list(variants));
    for (Achievement& next : list) {
      if (goal_.budget_ms && !goal_.met(next) && !found_.front.empty()) break;
      ALCOVE_TRY(next.rmse, rmse(next.choice));
      if (found_.front.empty() || goal_.rmse(next) < goal_.rmse(found_.chosen()))
        found_.front.push_back(next);
      if (goal_.tolerance && goal_.met(next)) break;
    }
    for (std::size_t i = 0; i < tried_.size(); ++i) {
      Choice with = found_.chosen().choice;
      tried_[i]->use(with);
      if (with == found_.chosen().choice) found_.features[i].verdict = "used";
    }
    return std::move(found_);
  }

 private:
  // Reports progress before some work, in units of a frame's fixed cost.
  void begin(double work) {
    if (world_.progress) world_.progress(done_ / std::max(planned_, done_ + work));
    done_ += work;
  }

  static double work(const OcclusionSettings& settings) {
    return 2.0 + samples_per_pixel(settings);
  }

  Result<Values> rmse(const Choice& choice) {
    begin(work(choice.settings));
    return world_.rmse(choice);
  }

  Result<Values> ms(const Choice& choice) {
    begin(1.0);
    return world_.ms(choice);
  }

  // Plans the work for so many variants of each number of samples.
  void plan(std::size_t variants) {
    planned_ = done_;
    for (const OcclusionSettings& settings : samples_)
      planned_ += static_cast<double>(variants) * (1.0 + work(settings));
  }

  // Measures each feature with few samples, at which all are quick. Returns the base with the
  // parameters that are worthwhile, with and without each other feature that is.
  Result<std::vector<Choice>> try_features() {
    const OcclusionSettings low = OcclusionSettings(ALCOVE_QUALITY_LOW);
    plan(1);
    planned_ += 1.0 + work(low) * (1.0 + std::size(kFeatures));
    Achievement base{base_};
    base.choice.settings = with_samples(base_.settings, low);
    ALCOVE_TRY(base.ms, ms(base.choice));
    ALCOVE_TRY(base.rmse, rmse(base.choice));
    std::vector<const Feature*> optional;
    for (const Feature& feature : kFeatures) {
      Achievement with = base;
      feature.use(with.choice);
      if (with.choice == base.choice || !passes::validate(with.choice.settings)) continue;
      tried_.push_back(&feature);
      FeatureEffect& effect = found_.features.emplace_back(FeatureEffect{.name = feature.name});
      const bool missing = feature.option != nullptr &&
                           (feature.available == nullptr || !(world_.*feature.available));
      const auto measured = rmse(with.choice).and_then([&](const Values& errors) {
        with.rmse = errors;
        return feature.takes_time && !missing ? ms(with.choice) : Result<Values>(base.ms);
      });
      if (!measured) {
        effect.problem = measured.error();
        continue;
      }
      with.ms = *measured;
      effect.rmse_change = goal_.rmse(with) / goal_.rmse(base) - 1.0;
      effect.ms_change = goal_.ms(with) / goal_.ms(base) - 1.0;
      effect.timed = !missing;
      if (missing) {
        effect.verdict = fmt::format("only considered with {}", feature.option);
      } else if (effect.rmse_change < -kWorthwhile ||
                 (effect.rmse_change < kWorthwhile && effect.ms_change < -kWorthwhile)) {
        effect.verdict = "it helps, but other settings are better here";
        if (feature.takes_time)
          optional.push_back(&feature);
        else
          base = with;
      }
    }
    std::vector<Choice> variants{base.choice};
    for (const Feature* feature : optional) {
      for (std::size_t i = 0, count = variants.size(); i < count; ++i)
        feature->use(variants.emplace_back(Choice(variants[i])));
    }
    return variants;
  }

  // Returns the variants with each number of samples and their times, from fast to slow.
  Result<std::vector<Achievement>> timed_list(const std::vector<Choice>& variants) {
    plan(variants.size());
    std::vector<Achievement> list;
    for (const OcclusionSettings& samples : samples_) {
      for (const Choice& variant : variants) {
        Achievement timed{variant};
        timed.choice.settings = with_samples(variant.settings, samples);
        if (!passes::validate(timed.choice.settings)) continue;
        ALCOVE_TRY(timed.ms, ms(timed.choice));
        list.push_back(timed);
      }
    }
    std::ranges::stable_sort(list, {}, [&](const Achievement& of) { return goal_.ms(of); });
    return list;
  }

  Choice base_;
  const RecommendationGoal& goal_;
  const RecommendationWorld& world_;
  std::vector<OcclusionSettings> samples_;
  double done_ = 0, planned_ = 0;  // work
  Recommendation found_;
  std::vector<const Feature*> tried_;  // of found_.features
};

}  // namespace

double RecommendationGoal::rmse(const Achievement& of) const { return weighted(of.rmse, weights); }

double RecommendationGoal::ms(const Achievement& of) const { return weighted(of.ms, weights); }

bool RecommendationGoal::met(const Achievement& by) const {
  return budget_ms ? ms(by) <= *budget_ms : rmse(by) <= *tolerance;
}

std::string FeatureEffect::sentence() const {
  if (!problem.empty()) return fmt::format("{}: not measured ({})", name, problem);
  const auto change = [](double relative, const char* quantity) {
    const double per_cent = 100.0 * std::abs(relative);
    return per_cent < 0.05
               ? fmt::format("no difference in {}", quantity)
               : fmt::format("{:.1f} % {} {}", per_cent, relative < 0 ? "less" : "more", quantity);
  };
  const std::string time = timed ? " for " + change(ms_change, "time") : "";
  return fmt::format("{}: {}{}; {}", name, change(rmse_change, "error"), time, verdict);
}

Result<Recommendation> recommend(const Choice& base, const RecommendationGoal& goal,
                                 const RecommendationWorld& world) {
  return Search(base, goal, world).run();
}

}  // namespace alcove::sample
