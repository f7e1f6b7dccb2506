#include <fmt/format.h>
#include <algorithm>
#include <iostream>
#include <iterator>

#include "cli/commands.h"
#include "cli/open_session.h"
#include "cli/render_command.h"
#include "cli/settings.h"
#include "evaluate/output_needs.h"
#include "evaluate/situations.h"
#include "support/progress.h"
#include "support/result.h"
#include "support/whole_file.h"

namespace alcove::sample {
namespace {

// Times in milliseconds for which an unmet tolerance is answered with the smallest error.
constexpr double kUsualTimes[] = {0.25, 0.5, 1.0, 2.0};

SituationWeights chosen_weights(const Options& options) {
  if (!options.situation) return kMixedWeights;
  SituationWeights weights{};
  weights[static_cast<std::size_t>(*options.situation)] = 1.0;
  return weights;
}

// The command line that prints the standing error of these settings.
std::string compare_line(const Options& options, const Session& session, const Choice& choice) {
  Shot shot{options.view, session.camera, choice.settings};
  shot.guard_band = choice.guard_band;
  std::vector<std::string> arguments = render_arguments(options, shot);
  arguments[1] = "compare";
  arguments.insert(arguments.end(), {"--spp", std::to_string(options.occlusion.spp)});
  return shell_line(arguments);
}

void print_achievement(const Achievement& of) {
  for (std::size_t i = 0; i < kSituationNames.size(); ++i) {
    std::cout << fmt::format("  {:10} RMSE {:.4f}, {:.4f} ms\n", kSituationNames[i], of.rmse[i],
                             of.ms[i]);
  }
}

// Prints the errors of the chosen settings in two other views, and whether the tolerance holds.
void check_other_views(const Options& options, const Session& session,
                       const RecommendationGoal& goal, const Achievement& chosen) {
  std::cout << "The same settings in other views of the scene:\n";
  for (const float angle : {0.6f, -0.6f}) {
    const Camera camera = orbited(session.camera, angle);
    const auto rmse =
        SituationErrors::create(session, {options.view, camera}, truth_options(options))
            .and_then([&](SituationErrors errors) { return errors.measure(chosen.choice); });
    if (!rmse) {
      std::cout << fmt::format("  orbited by {:g} radians: not checked ({})\n", angle,
                               rmse.error());
      continue;
    }
    const double error = goal.rmse({chosen.choice, *rmse, chosen.ms});
    std::cout << fmt::format("  orbited by {:g} radians: RMSE {:.4f}", angle, error);
    if (goal.tolerance) {
      std::cout << (error <= *goal.tolerance
                        ? ", within the tolerance"
                        : fmt::format(", {:.0f} % above the tolerance",
                                      100.0 * (error / *goal.tolerance - 1.0)));
    }
    std::cout << "\n" << std::flush;
  }
}

Result<void> write_settings(const Options& options, const Choice& choice) {
  if (options.settings_out.empty()) return {};
  return write_text(options.settings_out, settings_text(choice)).map([&] {
    std::cout << "The settings are in " << options.settings_out.string()
              << "; alcoveReadSettings reads them, and --settings"
              << (choice.guard_band > 0.0
                      ? fmt::format(" with --guard-band {:g} beside it", choice.guard_band)
                      : "")
              << "\n";
  });
}

// The message if nothing meets the goal.
std::string unmet_message(const RecommendationGoal& goal, const std::string& closest) {
  return goal.budget_ms
             ? fmt::format("no setting takes at most {:g} ms in this view; the fastest is {}",
                           *goal.budget_ms, closest)
             : fmt::format(
                   "no setting has an error of at most {:g} in this view; the most accurate "
                   "is {}",
                   *goal.tolerance, closest);
}

// Prints the smallest error within the times that people have.
void print_within_usual_times(const RecommendationGoal& goal, const Recommendation& found) {
  for (const double limit : kUsualTimes) {
    const auto slower = std::ranges::find_if(
        found.front, [&](const Achievement& of) { return goal.ms(of) > limit; });
    if (slower == found.front.begin()) continue;
    const Achievement& best = *std::prev(slower);
    std::cout << fmt::format("Within {:g} ms the smallest error is {:.4f}, in {:.4f} ms: {}\n",
                             limit, goal.rmse(best), goal.ms(best), choice_text(best.choice));
  }
}

}  // namespace

Result<void> run_recommend(const Options& options) {
  if (!options.settings_out.empty()) ALCOVE_TRY_VOID(check_writable(options.settings_out));
  ALCOVE_TRY(const Session session, open_session(options));
  std::cerr << "Measuring errors and modelling times, which takes about a minute\n";
  const RecommendationGoal goal{options.budget_ms, options.tolerance, chosen_weights(options)};
  ALCOVE_TRY(const auto passes_ms, setting_times(options, session));
  const SettingTimes times = [&](const Choice& choice) {
    return passes_ms(choice).map([&](std::array<double, 3> ms) {
      const HiddenDepths drawn = hidden_depths_of(choice.settings);
      for (double& value : ms)
        value += (drawn.second_layer ? options.second_layer_ms.value_or(0.0) : 0.0) +
                 (drawn.back_faces ? options.back_faces_ms.value_or(0.0) : 0.0);
      return ms;
    });
  };
  ALCOVE_TRY(auto errors, SituationErrors::create(session, {options.view, session.camera},
                                                  truth_options(options)));
  const RecommendationWorld world{[&](const Choice& choice) { return errors.measure(choice); },
                                  times, print_progress("settings"),
                                  options.second_layer_ms.has_value(),
                                  options.back_faces_ms.has_value()};
  ALCOVE_TRY(const Recommendation found,
             recommend({session.settings, options.view.guard_band}, goal, world));
  ALCOVE_TRY_VOID(check_validation(*session.gpu));
  const Achievement& chosen = found.chosen();
  const std::string text = fmt::format("{}: RMSE {:.4f} in {:.4f} ms", choice_text(chosen.choice),
                                       goal.rmse(chosen), goal.ms(chosen));
  if (goal.met(chosen)) std::cout << text << "\n";
  print_achievement(chosen);
  std::cout << fmt::format(
      "RMSE of visibility against ray-traced truth at {}x{}; {}\n"
      "Each feature, beside few samples per pixel:\n",
      options.view.width, options.view.height, clock_text(options, session));
  for (const FeatureEffect& feature : found.features)
    std::cout << "  " << feature.sentence() << "\n";
  ALCOVE_TRY(const auto needs, view_needs(session, errors.truths(), times, goal, chosen));
  std::cout << "The outputs and inputs that the materials in view need:\n";
  for (const std::string& need : needs) std::cout << "  " << need << "\n";
  if (!goal.met(chosen)) {
    if (goal.tolerance) print_within_usual_times(goal, found);
    return Failure(unmet_message(goal, text));
  }
  std::cout << std::flush;
  check_other_views(options, session, goal, chosen);
  std::cout << "The standing error again, and pictures:\n"
            << compare_line(options, session, chosen.choice) << "\n";
  return write_settings(options, chosen.choice);
}

}  // namespace alcove::sample
