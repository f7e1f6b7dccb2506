#include <fmt/format.h>
#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "alcove/passes/setting_names.h"
#include "cli/commands.h"
#include "cli/open_session.h"
#include "cli/render_command.h"
#include "evaluate/measured_trade.h"
#include "evaluate/situations.h"
#include "render/settings_json.h"
#include "support/mib.h"
#include "support/progress.h"
#include "support/whole_file.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;
using Done = tl::expected<void, std::string>;

std::string shown(const TradePoint& point) {
  return fmt::format("{}: RMSE {:.4f} in {:.3f} ms, {:.1f} MiB", point.name, point.rmse,
                     point.time_ms, mib(point.bytes));
}

const TradePoint* chosen_of(const Trade& trade, const Options& options) {
  return options.budget_ms ? least_error_within_ms(trade.points, *options.budget_ms)
                           : fastest_within_rmse(trade.points, *options.tolerance);
}

// The message if no setting is within the budget or tolerance. It names the closest one.
std::string no_choice_message(const Trade& trade, const Options& options) {
  if (options.budget_ms) {
    return fmt::format("no setting takes at most {:g} ms in this view; the fastest is {}",
                       *options.budget_ms, shown(trade.points.front()));
  }
  const TradePoint& nearest = *std::ranges::min_element(trade.points, {}, &TradePoint::rmse);
  return fmt::format(
      "no setting has an error of at most {:g} in this view; the most accurate is {}",
      *options.tolerance, shown(nearest));
}

// Prints the next faster and the next more accurate point of the Pareto front.
void print_neighbours(const Trade& trade, const TradePoint& chosen) {
  const auto own = static_cast<std::size_t>(&chosen - trade.points.data());
  for (std::size_t i = own; i-- > 0;) {
    if (trade.on_pareto_front[i]) {
      std::cout << "  faster:         " << shown(trade.points[i]) << "\n";
      break;
    }
  }
  for (std::size_t i = own + 1; i < trade.points.size(); ++i) {
    if (trade.on_pareto_front[i]) {
      std::cout << "  more accurate:  " << shown(trade.points[i]) << "\n";
      break;
    }
  }
}

// Chooses among numbers of samples by times that are measured on the device.
Done recommend_by_clock(const Options& options, const Session& session) {
  auto measured = measure_trade(session, static_setup(options, session.camera),
                                truth_options(options), options.clock);
  if (!measured) {
    return Failure(std::move(measured.error()));
  }
  const Trade trade = trade_of(std::move(measured->points));
  const TradePoint* chosen = chosen_of(trade, options);
  if (chosen == nullptr) {
    return Failure(no_choice_message(trade, options));
  }
  std::cout << measured->note << shown(*chosen) << "\n";
  print_neighbours(trade, *chosen);
  const Shot shot{session.camera,     chosen->settings,    std::nullopt,
                  options.view.width, options.view.height, options.view.frames};
  std::cout << fmt::format("RMSE of visibility against ray-traced truth; {} at {}x{} on {}\n{}\n",
                           measured->clock_title, options.view.width, options.view.height,
                           session.gpu->device().properties().deviceName,
                           shell_line(render_arguments(options, shot)));
  return {};
}

SituationWeights weights_of(const Options& options) {
  if (!options.situation) {
    return kMixedWeights;
  }
  SituationWeights weights{};
  weights[static_cast<std::size_t>(*options.situation)] = 1.0;
  return weights;
}

std::string samples_text(const passes::OcclusionSettings& settings) {
  return fmt::format("tile_size={} slices={} steps={}{}{}", settings.tile_size, settings.slices,
                     settings.steps, settings.half_resolution ? " half_resolution=true" : "",
                     settings.depth_layers > 1 ? " depth_layers=2" : "");
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
Done check_other_views(const Options& options, const Session& session,
                       const RecommendationGoal& goal, const Achievement& chosen) {
  for (const Camera& camera : other_views(session)) {
    auto errors =
        SituationErrors::create(session, static_setup(options, camera), truth_options(options));
    const auto rmse =
        errors ? errors->measure(chosen.settings)
               : tl::expected<std::array<double, 3>, std::string>(Failure(errors.error()));
    if (!rmse) {
      std::cout << "  view " << camera.name << ": not checked (" << rmse.error() << ")\n";
      continue;
    }
    const double error = goal.rmse({chosen.settings, *rmse, chosen.ms});
    std::cout << fmt::format("  view {}: RMSE {:.4f}", camera.name, error);
    if (goal.tolerance) {
      std::cout << (error <= *goal.tolerance
                        ? ", within the tolerance"
                        : fmt::format(", {:.0f} % above the tolerance",
                                      100.0 * (error / *goal.tolerance - 1.0)));
    }
    std::cout << "\n" << std::flush;
  }
  return {};
}

Done write_settings(const Options& options, const passes::OcclusionSettings& settings) {
  if (options.settings_out.empty()) {
    return {};
  }
  nlohmann::ordered_json json{{"settings", to_json(settings)}};
  json["settings"].erase("radius");  // it belongs to the scene
  return write_text(options.settings_out, json.dump(2) + "\n").map([&] {
    std::cout << "The settings are in " << options.settings_out.string()
              << "; --settings reads them\n";
  });
}

// The message if nothing meets the goal.
std::string unmet_message(const RecommendationGoal& goal, const Achievement& closest) {
  const std::string shown =
      fmt::format("{}: RMSE {:.4f} in {:.4f} ms", samples_text(closest.settings),
                  goal.rmse(closest), goal.ms(closest));
  return goal.budget_ms
             ? fmt::format("no setting takes at most {:g} ms in this view; the fastest is {}",
                           *goal.budget_ms, shown)
             : fmt::format(
                   "no setting has an error of at most {:g} in this view; the most "
                   "accurate is {}",
                   *goal.tolerance, shown);
}

// Measures all settings of measure_all(), and prints them and the best of them.
Done compare_with_all(const passes::OcclusionSettings& base, const RecommendationGoal& goal,
                      const RecommendationWorld& world, const Achievement& chosen) {
  const auto all = measure_all(base, world);
  if (!all) {
    return Failure(all.error());
  }
  const Achievement* best = nullptr;
  std::cout << fmt::format("  all settings: {:47}RMSE       ms\n", "");
  for (const Achievement& one : *all) {
    std::cout << fmt::format("    {:56} {:.4f} {:.4f}\n", samples_text(one.settings),
                             goal.rmse(one), goal.ms(one));
    best = best == nullptr || goal.prefers(one, *best) ? &one : best;
  }
  std::cout << fmt::format(
      "  the best of them: {}: RMSE {:.4f} in {:.4f} ms; the search's has {:+.1f} % error and "
      "{:+.1f} % time\n",
      samples_text(best->settings), goal.rmse(*best), goal.ms(*best),
      100.0 * (goal.rmse(chosen) / goal.rmse(*best) - 1.0),
      100.0 * (goal.ms(chosen) / goal.ms(*best) - 1.0));
  return {};
}

Done recommend_by_model(const Options& options, const Session& session,
                        const ModelledTimes& times) {
  const RecommendationGoal goal{options.budget_ms, options.tolerance, weights_of(options)};
  auto errors = SituationErrors::create(session, static_setup(options, session.camera),
                                        truth_options(options));
  if (!errors) {
    return Failure(std::move(errors.error()));
  }
  constexpr double kExpected = 60;  // calls; their number depends on what they find
  double calls = 0;
  const Progress progress = print_progress("settings");
  const auto advance = [&] { progress(std::min(++calls / kExpected, 0.99)); };
  const RecommendationWorld world{
      [&](const passes::OcclusionSettings& settings) -> tl::expected<Achievement, std::string> {
        advance();
        const auto ms = times.measure(settings);
        if (!ms) {
          return Failure(ms.error());
        }
        const auto rmse = errors->measure(settings);
        if (!rmse) {
          return Failure(rmse.error());
        }
        return Achievement{settings, *rmse, *ms};
      },
      [&](const passes::OcclusionSettings& settings) {
        advance();
        return times.measure(settings);
      }};
  const auto found = recommend(session.settings, goal, world);
  if (!found) {
    return Failure(found.error());
  }
  if (auto valid = check_validation(*session.gpu); !valid) {
    return valid;
  }
  const Achievement& chosen = found->chosen;
  if (!goal.met(chosen)) {
    return Failure(unmet_message(goal, chosen));
  }
  std::cout << fmt::format("{}: RMSE {:.4f} in {:.4f} ms\n", samples_text(chosen.settings),
                           goal.rmse(chosen), goal.ms(chosen));
  print_achievement(chosen);
  for (const FeatureEffect& feature : found->features) {
    std::cout << "  " << feature.sentence() << "\n";
  }
  std::cout << std::flush;
  if (auto checked = check_other_views(options, session, goal, chosen); !checked) {
    return checked;
  }
  if (options.exhaustive) {
    if (auto compared = compare_with_all(session.settings, goal, world, chosen); !compared) {
      return compared;
    }
  }
  const Shot shot{session.camera,     chosen.settings,     std::nullopt,
                  options.view.width, options.view.height, options.view.frames};
  std::cout << fmt::format(
      "RMSE of visibility against ray-traced truth at {}x{}; modelled time at {}x{} on {}\n{}\n",
      options.view.width, options.view.height, options.target_width, options.target_height,
      options.gpu->title, shell_line(render_arguments(options, shot)));
  return write_settings(options, chosen.settings);
}

}  // namespace

Done run_recommend(const Options& options) {
  const auto session = open_session(options);
  if (!session) {
    return Failure(session.error());
  }
  if (options.clock.value_or(Clock::modelled) != Clock::modelled) {
    return recommend_by_clock(options, *session);
  }
  const auto times = modelled_times(options);
  if (times) {
    return recommend_by_model(options, *session, *times);
  }
  if (options.clock) {
    return Failure(times.error());
  }
  std::cerr << "note: " << times.error() << " Times are measured on the device instead.\n";
  return recommend_by_clock(options, *session);
}

}  // namespace alcove::sample
