#include <fmt/format.h>
#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/open_session.h"
#include "cli/render_command.h"
#include "evaluate/error_split.h"
#include "evaluate/errors.h"
#include "evaluate/situations.h"
#include "evaluate/trade.h"
#include "gpu_cost/presets.h"
#include "gpu_cost/xegtao.h"
#include "report/report_page.h"
#include "support/printable.h"
#include "support/progress.h"
#include "support/try.h"
#include "support/whole_file.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;
using Json = nlohmann::ordered_json;
using passes::OcclusionSettings;
using passes::Quality;

constexpr auto kFirst = static_cast<std::size_t>(Situation::first);
constexpr auto kMoving = static_cast<std::size_t>(Situation::moving);
constexpr auto kStanding = static_cast<std::size_t>(Situation::standing);

// The part of the page about one scene.
class ScenePage {
 public:
  ScenePage(const Options& options, const Session& session, const ModelledTimes& times,
            SituationErrors errors)
      : options_(options), session_(session), times_(times), errors_(std::move(errors)) {}

  tl::expected<Json, std::string> make() {
    auto done = add_points()
                    .and_then([&] { return add_requirements(); })
                    .and_then([&] { return add_pictures(); })
                    .and_then([&] { return add_split(); })
                    .and_then([&] { return add_plan(); });
    if (!done) return Failure(std::move(done.error()));
    json_["name"] = options_.scene.empty() ? "builtin" : printable(options_.scene);
    json_["points"] = std::move(points_);
    return std::move(json_);
  }

 private:
  using Done = tl::expected<void, std::string>;

  tl::expected<Achievement, std::string> measure(const OcclusionSettings& settings) {
    ALCOVE_TRY(const auto ms, times_.measure(settings));
    ALCOVE_TRY(const auto rmse, errors_.measure(settings));
    return Achievement{settings, rmse, ms};
  }

  void add_point(const std::string& name, const Achievement& of, bool preset, bool recommended) {
    const Shot shot{session_.camera,     of.settings,          std::nullopt,
                    options_.view.width, options_.view.height, options_.view.frames};
    points_.push_back({{"name", name},
                       {"ms", of.ms[kMoving]},
                       {"rmse", of.rmse[kMoving]},
                       {"rmse_each", {of.rmse[kMoving], of.rmse[kStanding], of.rmse[kFirst]}},
                       {"ms_each", {of.ms[kMoving], of.ms[kStanding]}},
                       {"preset", preset},
                       {"recommended", recommended},
                       {"command", shell_line(render_arguments(options_, shot))}});
  }

  // The presets, and numbers of samples between them.
  Done add_points() {
    const std::vector<Variant> variants = preset_sweep(session_.settings);
    const Progress progress = print_progress("settings");
    for (std::size_t i = 0; i < variants.size(); ++i) {
      ALCOVE_TRY(const auto found, measure(variants[i].settings));
      const bool preset = std::ranges::any_of(
          presets(), [&](Quality quality) { return variants[i].name == passes::name_of(quality); });
      add_point(variants[i].name, found, preset, false);
      progress(static_cast<double>(i + 1) / static_cast<double>(variants.size()));
    }
    return {};
  }

  // The settings that `recommend` finds within the time of `medium`.
  Done add_requirements() {
    OcclusionSettings medium = passes::quality_settings(Quality::medium, session_.settings.radius);
    ALCOVE_TRY(const auto limit, times_.measure(medium));
    RecommendationGoal goal;
    goal.budget_ms = goal.ms({medium, {}, limit});
    const RecommendationWorld world{
        [&](const OcclusionSettings& settings) { return measure(settings); },
        [&](const OcclusionSettings& settings) { return times_.measure(settings); }};
    ALCOVE_TRY(const auto found, recommend(medium, goal, world));
    add_point("recommended within the time of medium", found.chosen, false, true);
    json_["summary"] = fmt::format(
        "Within the time of medium ({:.4f} ms): tiles of {}x{}, {} slices of {} steps, {} depth "
        "layers; RMSE {:.4f}.",
        *goal.budget_ms, found.chosen.settings.tile_size, found.chosen.settings.tile_size,
        found.chosen.settings.slices, found.chosen.settings.steps,
        found.chosen.settings.depth_layers, goal.rmse(found.chosen));
    json_["requirements"] = Json::array();
    for (const FeatureEffect& feature : found.features) {
      json_["requirements"].push_back(feature.sentence());
    }
    return {};
  }

  template <typename Picture>
  Done add_picture(const char* list, const std::string& name, const Picture& picture) {
    return data_uri(picture, options_.out).map([&](std::string uri) {
      json_[list].push_back({{"name", name}, {"image", std::move(uri)}});
    });
  }

  Done add_pictures() {
    const Image<float>& truth = errors_.truths().scene.visibility;
    const Image<float> open(truth.width, truth.height, 1.0f);
    Done done = add_picture("pictures", "truth", truth).and_then([&] {
      return add_picture("pictures", "no occlusion", open);
    });
    for (const Quality quality : presets()) {
      const std::string name(passes::name_of(quality));
      ALCOVE_TRY(const auto visibility,
                 errors_.draw(passes::quality_settings(quality, session_.settings.radius),
                              options_.view.frames, 0));
      done = done.and_then([&] { return add_picture("pictures", name, visibility); }).and_then([&] {
        return add_picture("errors", name, error_colours(visibility, truth));
      });
    }
    return done;
  }

  // The causes of the error of `medium`.
  Done add_split() {
    const auto split =
        split_error(*session_.gpu, session_.scene, static_setup(options_, session_.camera),
                    passes::quality_settings(Quality::medium, session_.settings.radius),
                    errors_.truths().scene.visibility, errors_.truths().surfaces);
    if (!split) return Failure(split.error());
    json_["split"] = to_json(*split);
    Done done;
    for (const ErrorCause& cause : split->causes) {
      const std::string name = fmt::format("{}: {:.1f} %", cause.name, 100.0 * cause.share);
      done = done.and_then([&] { return add_picture("causes", name, picture_of(cause)); });
    }
    return done;
  }

  Done add_plan() {
    ALCOVE_TRY(auto text, plan_text(session_, options_));
    json_["plan"] = std::move(text);
    return {};
  }

  const Options& options_;
  const Session& session_;
  const ModelledTimes& times_;
  SituationErrors errors_;
  Json json_;
  Json points_ = Json::array();
};

}  // namespace

tl::expected<void, std::string> run_report(const Options& options) {
  ALCOVE_TRY(const auto folder, OutputFolder::create(options.out));
  // A missing Chart.js is reported before the measurement, which takes minutes.
  ALCOVE_TRY_VOID(report_page({}));
  ALCOVE_TRY(const auto times, modelled_times(options));
  Json data{{"gpu", options.gpu->title},
            {"target", fmt::format("{}x{}", options.target_width, options.target_height)},
            {"size", fmt::format("{}x{}", options.view.width, options.view.height)},
            {"peers", Json::array()}};
  for (const XeGtao& peer : {kXeGtao[1], kXeGtaoHigh}) {
    data["peers"].push_back(
        {{"name", peer.name},
         {"ms", xegtao_ms(*options.gpu, peer, options.target_width, options.target_height)}});
  }
  const std::vector<std::string> scenes =
      options.scenes.empty() ? std::vector<std::string>{""} : options.scenes;
  for (const std::string& scene : scenes) {
    Options one = options;
    one.scene = scene;
    ALCOVE_TRY(const auto session, open_session(one));
    data["device"] = session.gpu->device().properties().deviceName;
    ALCOVE_TRY(auto errors, SituationErrors::create(session, static_setup(one, session.camera),
                                                    truth_options(one)));
    ALCOVE_TRY(auto page, ScenePage(one, session, times, std::move(errors)).make());
    data["scenes"].push_back(std::move(page));
  }
  ALCOVE_TRY(const auto page, report_page(data));
  return write_text(options.out / "index.html", page).map([&] {
    std::cout << "index.html is in " << options.out.string() << "\n";
  });
}

}  // namespace alcove::sample
