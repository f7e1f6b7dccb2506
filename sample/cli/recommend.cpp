#include <fmt/format.h>
#include <iostream>

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

using Failure = tl::unexpected<std::string>;

SituationWeights chosen_weights(const Options& options) {
  if (!options.situation) return kMixedWeights;
  SituationWeights weights{};
  weights[static_cast<std::size_t>(*options.situation)] = 1.0;
  return weights;
}

// The command line that prints the standing error of these settings.
std::string compare_line(const Options& options, const Session& session, const Choice& choice) {
  std::vector<std::string> arguments =
      render_arguments(options, {session.camera, choice.settings, std::nullopt, options.view.width,
                                 options.view.height, choice.guard_band, options.view.frames});
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

// Two other views of the scene: its other cameras, or the camera orbited.
std::vector<Camera> other_views(const Session& session) {
  std::vector<Camera> views;
  for (const Camera& camera : session.scene.cameras) {
    if (camera.name != session.camera.name && views.size() < 2) {
      views.push_back(camera);
      views.back().reversed_z = session.camera.reversed_z;
    }
  }
  for (const float angle : {0.6f, -0.6f}) {
    if (views.size() < 2) {
      views.push_back(orbited(session.camera, angle));
      views.back().name = fmt::format("orbited by {:g} radians", angle);
    }
  }
  return views;
}

// Prints the errors of the chosen settings in two other views, and whether the tolerance holds.
void check_other_views(const Options& options, const Session& session,
                       const RecommendationGoal& goal, const Achievement& chosen) {
  std::cout << "The same settings in other views of the scene:\n";
  for (const Camera& camera : other_views(session)) {
    const auto rmse =
        SituationErrors::create(session, static_setup(options, camera), truth_options(options))
            .and_then([&](SituationErrors errors) { return errors.measure(chosen.choice); });
    if (!rmse) {
      std::cout << "  view " << camera.name << ": not checked (" << rmse.error() << ")\n";
      continue;
    }
    const double error = goal.rmse({chosen.choice, *rmse, chosen.ms});
    std::cout << fmt::format("  view {}: RMSE {:.4f}", camera.name, error);
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

}  // namespace

Result<void> run_recommend(const Options& options) {
  if (!options.settings_out.empty()) ALCOVE_TRY_VOID(check_writable(options.settings_out));
  ALCOVE_TRY(const Session session, open_session(options));
  std::cerr << "Measuring errors and modelling times, which takes one or two minutes\n";
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
  ALCOVE_TRY(auto errors, SituationErrors::create(session, static_setup(options, session.camera),
                                                  truth_options(options)));
  const RecommendationWorld world{[&](const Choice& choice) { return errors.measure(choice); },
                                  times, print_progress("settings"),
                                  options.second_layer_ms.has_value(),
                                  options.back_faces_ms.has_value()};
  ALCOVE_TRY(const Recommendation found, recommend(session.settings, goal, world));
  ALCOVE_TRY_VOID(check_validation(*session.gpu));
  const Achievement& chosen = found.chosen;
  const std::string text = fmt::format("{}: RMSE {:.4f} in {:.4f} ms", choice_text(chosen.choice),
                                       goal.rmse(chosen), goal.ms(chosen));
  if (goal.met(chosen)) std::cout << text << "\n";
  print_achievement(chosen);
  std::cout << fmt::format(
      "RMSE of visibility against ray-traced truth at {}x{}; {}, without the g-buffer of a guard "
      "band\nEach feature, beside the settings to which it was added:\n",
      options.view.width, options.view.height, clock_text(options, session));
  for (const FeatureEffect& feature : found.features)
    std::cout << "  " << feature.sentence() << "\n";
  ALCOVE_TRY(const auto needs, view_needs(session, errors.truths(), times, goal, chosen));
  std::cout << "The outputs and inputs that the materials in view need:\n";
  for (const std::string& need : needs) std::cout << "  " << need << "\n";
  for (const Achievement& best : found.within_usual_times) {
    std::cout << fmt::format("The smallest error found within {:.4f} ms: RMSE {:.4f}, {}\n",
                             goal.ms(best), goal.rmse(best), choice_text(best.choice));
  }
  std::cout << std::flush;
  if (!goal.met(chosen)) return Failure(unmet_message(goal, text));
  check_other_views(options, session, goal, chosen);
  std::cout << "The standing error again, and pictures:\n"
            << compare_line(options, session, chosen.choice) << "\n";
  return write_settings(options, chosen.choice);
}

}  // namespace alcove::sample
