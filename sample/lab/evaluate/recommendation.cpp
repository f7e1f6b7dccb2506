#include "evaluate/recommendation.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "alcove/passes/setting_table.h"
#include "evaluate/sweep.h"

namespace alcove::sample {
namespace {

using Values = std::array<double, 3>;  // by Situation

struct Feature {
  const char* name;
  void (*use)(Choice& choice);
};

static_assert(kGuardBand == 10.0);
constexpr Feature kFeatures[] = {
    {"a second depth layer", [](Choice& c) { c.settings.depth_layers = 2; }},
    {"a guard band of 10 % of the height", [](Choice& c) { c.guard_band = kGuardBand; }},
    {"thickness from back faces, whose time differs most between GPUs",
     [](Choice& c) { c.settings.thickness_unit = ALCOVE_THICKNESS_UNIT_BACK_FACES; }},
    {"a thickness of 0.05", [](Choice& c) { c.settings.thickness = 0.05f; }},
    {"a thickness of 0.5", [](Choice& c) { c.settings.thickness = 0.5f; }},
    {"a hidden occlusion of 0.1", [](Choice& c) { c.settings.hidden_occlusion = 0.1f; }},
    {"a hidden occlusion of 0.7", [](Choice& c) { c.settings.hidden_occlusion = 0.7f; }},
    {"no history", [](Choice& c) { c.settings.history_frames = 0; }},
};

// Returns `choice` with the numbers of samples of other settings.
Choice with_samples(Choice choice, const OcclusionSettings& samples) {
  choice.settings.tile_size = samples.tile_size;
  choice.settings.slices = samples.slices;
  choice.settings.steps = samples.steps;
  choice.settings.half_resolution = samples.half_resolution;
  return choice;
}

// The number of samples for each pixel of the image.
double samples_per_pixel(const OcclusionSettings& settings) {
  const double pixels =
      settings.tile_size * settings.tile_size * (settings.half_resolution ? 4 : 1);
  return settings.slices * settings.steps / pixels;
}

double weighted(const Values& values, const SituationWeights& weights) {
  return std::inner_product(values.begin(), values.end(), weights.begin(), 0.0);
}

// Modelling a time and measuring an error take seconds each, so both are done when they are needed
// and kept.
class Search {
 public:
  Search(const OcclusionSettings& base, const RecommendationGoal& goal,
         const RecommendationWorld& world)
      : base_(base), goal_(goal), world_(world) {}

  Result<Recommendation> run() {
    for (Variant& variant : preset_sweep(base_)) ladder_.push_back(variant.settings);
    std::ranges::stable_sort(ladder_, {}, samples_per_pixel);
    if (goal_.budget_ms) ALCOVE_TRY_VOID(sort_by_time());
    ALCOVE_TRY_VOID(choose_samples());
    for (const Feature& feature : kFeatures) try_feature(feature);
    if (goal_.tolerance && !goal_.met(found_.chosen)) {
      ALCOVE_TRY_VOID(find_within_usual_times());
      return std::move(found_);
    }
    if (goal_.tolerance) try_with_fewer_samples(found_.chosen.choice);
    refine();
    return std::move(found_);
  }

 private:
  // Reports progress before an error is measured or a time is modelled.
  void count() {
    constexpr double kUsual = 60.0;  // number of these
    constexpr double kMost = 0.95;
    if (world_.progress) world_.progress(std::min(++counted_ / kUsual, kMost));
  }

  const Achievement* measured(const Choice& choice) const {
    const auto known = std::ranges::find(measured_, choice, &Achievement::choice);
    return known == measured_.end() ? nullptr : &*known;
  }

  Result<Values> ms(const Choice& choice) {
    const auto known = std::ranges::find(timed_, choice, &std::pair<Choice, Values>::first);
    if (known != timed_.end()) return known->second;
    count();
    ALCOVE_TRY(const Values values, world_.ms(choice));
    timed_.emplace_back(choice, values);
    return values;
  }

  Result<Values> rmse(const Choice& choice) {
    const auto known = std::ranges::find(errors_, choice, &std::pair<Choice, Values>::first);
    if (known != errors_.end()) return known->second;
    count();
    ALCOVE_TRY(const Values values, world_.rmse(choice));
    errors_.emplace_back(choice, values);
    return values;
  }

  // Measures a choice and chooses it if the goal prefers it by the margin.
  Result<Achievement> consider(const Choice& choice, double margin = 0) {
    if (const Achievement* known = measured(choice)) return *known;
    ALCOVE_TRY(const Values times, ms(choice));
    ALCOVE_TRY(const Values errors, rmse(choice));
    measured_.push_back({choice, errors, times});
    const Achievement& result = measured_.back();
    if (measured_.size() == 1 || goal_.prefers(result, found_.chosen, margin))
      found_.chosen = result;
    return result;
  }

  // Measures a choice only if its time does not rule it out, and returns whether it did. Choices
  // that fail are left out.
  bool consider_if_promising(const Choice& choice, double margin = 0) {
    if (!passes::validate(choice.settings) || measured(choice) != nullptr) return false;
    const auto times = ms(choice);
    if (!times) return false;
    const double limit = goal_.budget_ms ? *goal_.budget_ms : goal_.ms(found_.chosen);
    return (!goal_.met(found_.chosen) || weighted(*times, goal_.weights) <= limit) &&
           consider(choice, margin).has_value();
  }

  // Sorts the ladder by time and leaves out rungs that are slower with fewer samples than others of
  // the same resolution. Features hardly change this order.
  Result<void> sort_by_time() {
    std::vector<std::pair<double, OcclusionSettings>> timed;
    for (const OcclusionSettings& samples : ladder_) {
      ALCOVE_TRY(const Values values, ms(with_samples({base_}, samples)));
      timed.emplace_back(weighted(values, goal_.weights), samples);
    }
    std::ranges::stable_sort(timed, {}, &std::pair<double, OcclusionSettings>::first);
    ladder_.clear();
    std::array<double, 2> most{};  // samples of the faster rungs, by resolution
    for (const auto& [time, samples] : timed) {
      double& faster = most.at(samples.half_resolution);
      if (samples_per_pixel(samples) >= faster) ladder_.push_back(samples);
      faster = std::max(faster, samples_per_pixel(samples));
    }
    return {};
  }

  // Returns the number of the first rungs of the ladder of which `is_within` is true. It is nearly
  // monotone.
  template <typename IsWithin>
  Result<std::size_t> rungs_within(const IsWithin& is_within) const {
    std::size_t low = 0;
    for (std::size_t high = ladder_.size(); low < high;) {
      const std::size_t middle = (low + high) / 2;
      ALCOVE_TRY(const bool within, is_within(ladder_[middle]));
      (within ? low : high) = within ? middle + 1 : middle;
    }
    return low;
  }

  // Considers `choice` with the most samples that take at most `ms_limit`, `most` of them.
  Result<void> consider_within(const Choice& choice, double ms_limit, std::size_t most,
                               double margin) {
    constexpr std::size_t kOutOfOrder = 3;  // faster ones among slower ones
    const auto is_within = [&](const OcclusionSettings& samples) -> Result<bool> {
      ALCOVE_TRY(const Values values, ms(with_samples(choice, samples)));
      return weighted(values, goal_.weights) <= ms_limit;
    };
    ALCOVE_TRY(const std::size_t within, rungs_within(is_within));
    std::size_t i = std::min(within + kOutOfOrder, ladder_.size());
    for (std::size_t count = 0; i-- > 0 && count < most;) {
      ALCOVE_TRY(const bool fits, is_within(ladder_[i]));
      if (!fits) continue;
      ALCOVE_TRY_VOID(consider(with_samples(choice, ladder_[i]), margin));
      ++count;
    }
    return {};
  }

  // Considers the numbers of samples that nearly use the budget up, or those around the fewest that
  // meet the tolerance.
  Result<void> choose_samples() {
    constexpr std::size_t kMost = 3;
    const Choice base{base_};
    if (goal_.budget_ms) {
      ALCOVE_TRY_VOID(consider_within(base, *goal_.budget_ms, kMost, 0));
      if (!measured_.empty()) return {};
      return consider(with_samples(base, ladder_.front())).map([](const Achievement&) {});
    }
    ALCOVE_TRY(const std::size_t unmet,
               rungs_within([&](const OcclusionSettings& samples) -> Result<bool> {
                 ALCOVE_TRY(const Values errors, rmse(with_samples(base, samples)));
                 return !(weighted(errors, goal_.weights) <= *goal_.tolerance);
               }));
    for (std::size_t i = unmet - std::min<std::size_t>(unmet, 2);
         i < std::min(unmet + 2, ladder_.size()); ++i)
      ALCOVE_TRY_VOID(consider(with_samples(base, ladder_[i])));
    return {};
  }

  // Returns the option that says that the host draws a depth that the settings read, if it does
  // not.
  const char* missing_depth(const OcclusionSettings& settings) const {
    if (passes::needs_second_depth(settings) && !world_.second_layer &&
        !passes::needs_second_depth(base_))
      return "--second-layer";
    if (passes::needs_back_depth(settings) && !world_.back_faces &&
        !passes::needs_back_depth(base_))
      return "--back-faces";
    return nullptr;
  }

  // Finds the smallest errors within the times that people have, for a tolerance that is not met.
  Result<void> find_within_usual_times() {
    const Choice features = found_.chosen.choice;
    for (const double limit : kUsualTimes) {
      ALCOVE_TRY_VOID(consider_within(features, limit, 1, 0));
      const RecommendationGoal within{limit, std::nullopt, goal_.weights};
      const auto best = std::ranges::min_element(
          measured_, [&](const auto& a, const auto& b) { return within.prefers(a, b); });
      if (within.met(*best)) found_.within_usual_times.push_back(*best);
    }
    return {};
  }

  void try_feature(const Feature& feature) {
    const Achievement before = found_.chosen;
    Choice with = before.choice;
    feature.use(with);
    if (with == before.choice || !passes::validate(with.settings)) return;
    if (const char* option = missing_depth(with.settings)) {
      const auto errors = rmse(with);
      FeatureEffect advice{.name = feature.name, .timed = false};
      if (errors) advice.rmse_change = weighted(*errors, goal_.weights) / goal_.rmse(before) - 1.0;
      if (!errors) advice.problem = errors.error();
      advice.verdict = fmt::format("only considered with {} MS, the time of drawing it", option);
      found_.features.push_back(std::move(advice));
      return;
    }
    const auto result = consider(with, kWorthwhile);
    if (!result) {
      found_.features.push_back({.name = feature.name, .problem = result.error()});
      return;
    }
    FeatureEffect effect{feature.name, goal_.rmse(*result) / goal_.rmse(before) - 1.0,
                         goal_.ms(*result) / goal_.ms(before) - 1.0};
    const bool helps = effect.rmse_change < -kWorthwhile;
    if (helps && goal_.budget_ms && !goal_.met(*result)) effect.verdict = "over the budget";
    if (helps && (goal_.tolerance || !goal_.met(*result)))
      try_with_fewer_samples(with, kWorthwhile);
    Choice chosen = found_.chosen.choice;
    feature.use(chosen);
    if (chosen == found_.chosen.choice && chosen != before.choice) effect.verdict = "used";
    found_.features.push_back(std::move(effect));
  }

  // Tries `with` at fewer samples: the most within a budget, or as few as a tolerance allows.
  void try_with_fewer_samples(const Choice& with, double margin = 0) {
    constexpr std::size_t kMost = 3;
    if (goal_.budget_ms) {
      (void)consider_within(with, *goal_.budget_ms, kMost, margin);
      return;
    }
    const auto rungs = static_cast<std::size_t>(
        std::ranges::count_if(ladder_, [&](const OcclusionSettings& samples) {
          return samples_per_pixel(samples) <= samples_per_pixel(with.settings);
        }));
    std::size_t missed = 0;
    for (std::size_t i = rungs; i-- > 0 && missed < kMost;) {
      const Choice fewer = with_samples(with, ladder_[i]);
      if (!consider_if_promising(fewer, margin)) continue;
      missed += goal_.met(*measured(fewer)) ? 0 : 1;
    }
  }

  // Changes one number of samples at a time, as long as that helps.
  void refine() {
    constexpr int kRounds = 3;
    for (int round = 0; round < kRounds; ++round) {
      const Achievement before = found_.chosen;
      const OcclusionSettings& from = before.choice.settings;
      // A tenth of a frame at least is the search, whose time is proportional to the samples. More
      // samples that exceed the limit even so are left out without modelling their time.
      const double limit = goal_.budget_ms ? *goal_.budget_ms : goal_.ms(before);
      const auto change = [&](auto AlcoveSettings::*field, auto value) {
        Choice changed = before.choice;
        changed.settings.*field = value;
        const double more = samples_per_pixel(changed.settings) / samples_per_pixel(from) - 1.0;
        const bool too_slow = more > 0 && goal_.ms(before) * (1.0 + 0.1 * more) > limit;
        // Fewer samples within a budget raise the error.
        const bool useless = more < 0 && goal_.budget_ms && goal_.met(before);
        if (!goal_.met(before) || !(too_slow || useless)) consider_if_promising(changed);
      };
      for (const std::uint32_t steps :
           {from.steps * 3 / 4, from.steps - 1, from.steps + 1, (from.steps * 4 + 2) / 3})
        change(&OcclusionSettings::steps, steps);
      change(&OcclusionSettings::slices, from.slices - 1);
      change(&OcclusionSettings::slices, from.slices + 1);
      change(&OcclusionSettings::tile_size, from.tile_size / 2);
      change(&OcclusionSettings::tile_size, from.tile_size * 2);
      if (found_.chosen.choice == before.choice) return;
    }
  }

  OcclusionSettings base_;
  const RecommendationGoal& goal_;
  const RecommendationWorld& world_;
  // From few samples per pixel to many; within a budget from fast to slow.
  std::vector<OcclusionSettings> ladder_;
  std::vector<Achievement> measured_;
  std::vector<std::pair<Choice, Values>> timed_, errors_;
  int counted_ = 0;
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
  const std::string time = timed ? " for " + change(ms_change, "time") : "";
  return fmt::format("{}: {}{}; {}", name, change(rmse_change, "error"), time, verdict);
}

Result<Recommendation> recommend(const OcclusionSettings& base, const RecommendationGoal& goal,
                                 const RecommendationWorld& world) {
  return Search(base, goal, world).run();
}

}  // namespace alcove::sample
