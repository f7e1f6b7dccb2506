#include <fmt/format.h>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/open_session.h"
#include "cli/render_command.h"
#include "evaluate/error_split.h"
#include "evaluate/errors.h"
#include "evaluate/output_needs.h"
#include "evaluate/situations.h"
#include "evaluate/sweep.h"
#include "gpu_cost/null_device.h"
#include "gpu_cost/presets.h"
#include "gpu_cost/xegtao.h"
#include "report/report_page.h"
#include "support/printable.h"
#include "support/progress.h"
#include "support/result.h"
#include "support/whole_file.h"

namespace alcove::sample {
namespace {

using Json = nlohmann::ordered_json;

constexpr auto kFirst = static_cast<std::size_t>(Situation::first);
constexpr auto kMoving = static_cast<std::size_t>(Situation::moving);
constexpr auto kStanding = static_cast<std::size_t>(Situation::standing);

// The part of the page about one scene.
class ScenePage {
 public:
  ScenePage(const Options& options, const Session& session, const SettingTimes& times,
            SituationErrors errors)
      : options_(options), session_(session), times_(times), errors_(std::move(errors)) {}

  Result<Json> make() {
    ALCOVE_TRY_VOID(add_points());
    ALCOVE_TRY_VOID(add_requirements());
    ALCOVE_TRY_VOID(add_pictures());
    ALCOVE_TRY_VOID(add_split());
    ALCOVE_TRY(json_["plan"], plan_text(session_, options_));
    json_["name"] = name_of_scene();
    json_["points"] = std::move(points_);
    return std::move(json_);
  }

 private:
  std::string name_of_scene() const {
    return options_.scene.empty()
               ? "builtin"
               : printable(std::filesystem::path(options_.scene).filename().string());
  }

  void add_point(const std::string& name, const Achievement& of, bool preset, bool recommended) {
    std::cout << fmt::format("  {:46}{:9.4f}{:10.4f}{:9.4f}{:11.4f}{:11.4f}\n", name,
                             of.rmse[kMoving], of.rmse[kStanding], of.rmse[kFirst], of.ms[kMoving],
                             of.ms[kStanding]);
    Shot shot{options_.view, session_.camera, of.choice.settings};
    shot.guard_band = of.choice.guard_band;
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
  Result<void> add_points() {
    const std::vector<Variant> variants = preset_sweep(session_.settings);
    std::cout << fmt::format("{}\n{:43}RMSE moving  standing    first  ms moving   standing\n",
                             name_of_scene(), "");
    const Progress progress = print_progress("settings");
    for (std::size_t i = 0; i < variants.size(); ++i) {
      Achievement found{{variants[i].settings}};
      ALCOVE_TRY(found.ms, times_(found.choice));
      ALCOVE_TRY(found.rmse, errors_.measure(found.choice));
      add_point(variants[i].name, found, i < presets().size(), false);  // presets come first
      progress(static_cast<double>(i + 1) / static_cast<double>(variants.size()));
    }
    return {};
  }

  // The settings that `recommend` finds within the time of `medium`.
  Result<void> add_requirements() {
    OcclusionSettings medium = OcclusionSettings(ALCOVE_QUALITY_MEDIUM, session_.settings.radius);
    ALCOVE_TRY(const auto limit, times_({medium}));
    ALCOVE_TRY(const auto medium_rmse, errors_.measure({medium}));
    RecommendationGoal goal;
    goal.budget_ms = goal.ms({{medium}, {}, limit});
    const RecommendationWorld world{[&](const Choice& choice) { return errors_.measure(choice); },
                                    times_, print_progress("search")};
    ALCOVE_TRY(const auto found, recommend({medium}, goal, world));
    add_point("recommended within the time of medium", found.chosen(), false, true);
    json_["summary"] = fmt::format(
        "Within the time of medium ({:.4f} ms, RMSE {:.4f}): {}; RMSE {:.4f}. These "
        "figures are means of the first frame (10 %), a moving camera (60 %) and a "
        "standing camera (30 %).",
        *goal.budget_ms, goal.rmse({{medium}, medium_rmse, limit}),
        choice_text(found.chosen().choice), goal.rmse(found.chosen()));
    json_["requirements"] = Json::array();
    for (const FeatureEffect& feature : found.features)
      json_["requirements"].push_back(feature.sentence());
    ALCOVE_TRY(const auto needs,
               view_needs(session_, errors_.truths(), times_, goal, found.chosen()));
    for (const std::string& need : needs) json_["requirements"].push_back(need);
    return {};
  }

  template <typename Picture>
  Result<void> add_picture(const char* list, const std::string& name, const Picture& picture) {
    return data_uri(picture, options_.out).map([&](std::string uri) {
      json_[list].push_back({{"name", name}, {"image", std::move(uri)}});
    });
  }

  Result<void> add_pictures() {
    const Image<float>& truth = errors_.truths().scene.visibility;
    const Image<float> open(truth.width, truth.height, 1.0f);
    ALCOVE_TRY_VOID(add_picture("pictures", "truth", truth));
    ALCOVE_TRY_VOID(add_picture("pictures", "no occlusion", open));
    for (const AlcoveQuality quality : presets()) {
      const std::string name(passes::kQualityNames.at(quality));
      ALCOVE_TRY(const auto visibility,
                 errors_.draw({OcclusionSettings(quality, session_.settings.radius)},
                              options_.view.frames, 0));
      ALCOVE_TRY_VOID(add_picture("pictures", name, visibility));
      ALCOVE_TRY_VOID(add_picture("errors", name, error_colours(visibility, truth)));
    }
    return {};
  }

  // The causes of the error of `medium`.
  Result<void> add_split() {
    ALCOVE_TRY(const ErrorSplit split,
               split_error(*session_.gpu, session_.scene, {options_.view, session_.camera},
                           OcclusionSettings(ALCOVE_QUALITY_MEDIUM, session_.settings.radius),
                           errors_.truths().scene.visibility, errors_.truths().surfaces));
    json_["split"] = to_json(split);
    for (const ErrorCause& cause : split.causes) {
      const std::string name = fmt::format("{}: {:.1f} %", cause.name, 100.0 * cause.share);
      ALCOVE_TRY_VOID(add_picture("causes", name, cause_picture(cause)));
    }
    return {};
  }

  const Options& options_;
  const Session& session_;
  const SettingTimes& times_;
  SituationErrors errors_;
  Json json_;
  Json points_ = Json::array();
};

}  // namespace

Result<void> run_report(const Options& options) {
  ALCOVE_TRY_VOID(create_folder(options.out));
  // A missing Chart.js is reported before the measurement, which takes minutes.
  ALCOVE_TRY_VOID(report_page({}));
  Json data{{"size", fmt::format("{}x{}", options.view.width, options.view.height)},
            {"peers", Json::array()}};
  std::string compiler;
  if (options.clock == Clock::modelled) {
    ALCOVE_TRY(const auto device, create_null_device(options.gpu->family));
    compiler = device.compiler;
  }
  for (const XeGtao& peer : {kXeGtao[1], kXeGtaoHigh}) {
    if (compiler != kXeGtaoCompiler) continue;
    data["peers"].push_back(
        {{"name", peer.name},
         {"ms", xegtao_ms(*options.gpu, peer, options.target_width, options.target_height)}});
  }
  Json report;
  const std::vector<std::string> scenes =
      options.scenes.empty() ? std::vector<std::string>{""} : options.scenes;
  // All scenes are loaded before the first is measured, so that a wrong name is reported at once.
  std::vector<Session> sessions;
  Options one = options;
  for (const std::string& scene : scenes) {
    one.scene = scene;
    ALCOVE_TRY(sessions.emplace_back(), load_session(one));
  }
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    one.scene = scenes[i];
    Session session = std::move(sessions[i]);
    ALCOVE_TRY(session.gpu, open_gpu(session.device));
    data["device"] = session.gpu->device().properties().deviceName;
    data["clock"] = clock_text(options, session);
    ALCOVE_TRY(const auto times, setting_times(one, session));
    ALCOVE_TRY(auto errors,
               SituationErrors::create(session, {one.view, session.camera}, truth_options(one)));
    ALCOVE_TRY(auto page, ScenePage(one, session, times, std::move(errors)).make());
    report["scenes"].push_back({{"name", page["name"]}, {"points", page["points"]}});
    data["scenes"].push_back(std::move(page));
  }
  report["time"] = data["clock"];
  ALCOVE_TRY(const auto page, report_page(data));
  ALCOVE_TRY_VOID(write_text(options.out / "report.json", report.dump(2) + "\n"));
  return write_text(options.out / "index.html", page).map([&] {
    std::cout << "index.html and report.json are in " << options.out.string() << "\n";
  });
}

}  // namespace alcove::sample
