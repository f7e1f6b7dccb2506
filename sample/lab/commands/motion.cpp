#include <fmt/format.h>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/open_session.h"
#include "evaluate/errors.h"
#include "evaluate/motion_run.h"
#include "render/settings_json.h"
#include "support/image_io.h"
#include "support/result.h"
#include "support/whole_file.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;
using Json = nlohmann::ordered_json;

Result<void> write_pictures(const std::filesystem::path& folder, MotionKind kind,
                            const std::vector<MotionPicture>& pictures) {
  for (const MotionPicture& picture : pictures) {
    const std::string name = fmt::format("{}_{}", name_of(kind), picture.frame);
    ALCOVE_TRY_VOID(write_png(folder / (name + ".png"), picture.visibility));
    ALCOVE_TRY_VOID(write_png(folder / (name + "_static.png"), picture.static_camera));
    ALCOVE_TRY_VOID(write_png(folder / (name + "_error.png"),
                              error_colours(picture.visibility, picture.truth)));
    ALCOVE_TRY_VOID(write_png(folder / (name + "_trails.png"),
                              error_colours(picture.visibility, picture.static_camera)));
  }
  return {};
}

Json to_json(const ErrorPair& errors) {
  return {{"pixels", errors.pixels},
          {"moving", errors.moving},
          {"static", errors.static_camera},
          {"ratio", errors.ratio()}};
}

Json to_json(const MotionReport& report) {
  Json json;
  for (const CutErrors& errors : report.after_cut) {
    json["after"].push_back(
        {{"frames", errors.frames}, {"kept", errors.kept}, {"restarted", errors.restarted}});
  }
  if (!report.after_cut.empty()) return json;
  json["px_per_frame"] = {{"mean", report.speed.mean},
                          {"percentile_95", report.speed.percentile_95}};
  for (std::size_t i = 0; i < report.errors.size(); ++i)
    json[kMotionErrorNames[i]] = to_json(report.errors[i]);
  const Flicker& flicker = report.flicker;
  json["flicker"] = {{"with_history", flicker.with_history},
                     {"without_history", flicker.without_history},
                     {"static", flicker.static_camera},
                     {"truth", flicker.truth},
                     {"ratio", flicker.ratio()}};
  json["weave"] = {{"moving", to_json(report.weave)}, {"static", to_json(report.static_weave)}};
  return json;
}

std::string format_table(MotionKind kind, const MotionReport& report) {
  if (!report.after_cut.empty()) {
    std::string out = "cut: RMSE by frames since the cut   kept     restarted history\n";
    for (const CutErrors& errors : report.after_cut)
      out += fmt::format("  {:<34}{:.4f}   {:.4f}\n", errors.frames, errors.kept, errors.restarted);
    return out;
  }
  std::string out = fmt::format(
      "{}: surfaces move by {:.1f} pixels per frame on average, 95 % by at most {:.1f}\n"
      "  RMSE against ray-traced truth     moving   static  ratio    pixels\n",
      name_of(kind), report.speed.mean, report.speed.percentile_95);
  for (std::size_t i = 0; i < report.errors.size(); ++i) {
    const ErrorPair& errors = report.errors[i];
    const auto error = static_cast<MotionError>(i);
    const int digits = error == MotionError::bent_normals ? 2 : 4;
    if (errors.pixels > 0) {
      out += fmt::format("  {:34}{:6.{}f}   {:6.{}f}{:8.2f}{:10}\n", kMotionErrorTitles[i],
                         errors.moving, digits, errors.static_camera, digits, errors.ratio(),
                         errors.pixels);
    } else if (error != MotionError::near_object) {
      out += fmt::format("  {:34}none\n", kMotionErrorTitles[i]);
    }
  }
  const Flicker& flicker = report.flicker;
  return out +
         fmt::format(
             "  change of visibility per frame    {:.4f} with history; {:.4f} without motion; the "
             "truth changes by at least {:.4f}\n"
             "    filtered, without history       {:.4f}: ratio {:.3f}\n"
             "  Moving: {}  Static: {}",
             flicker.with_history, flicker.static_camera, flicker.truth, flicker.without_history,
             flicker.ratio(), weave_line(report.weave), weave_line(report.static_weave));
}

}  // namespace

Result<void> run_motion(const Options& options) {
  ALCOVE_TRY(const auto session, open_session(options));
  if (session.settings.history_frames == 0) {
    return Failure(
        "The occlusion keeps no history, so there is nothing to follow in motion: give another "
        "--quality, or --set history_frames=32.");
  }
  ALCOVE_TRY(const auto rays, RayScene::create(session.scene));
  const float aspect =
      static_cast<float>(options.view.width) / static_cast<float>(options.view.height);
  ALCOVE_TRY(const auto start, motion_start(rays, session.camera, aspect, session.settings.radius));
  const MotionSetup setup{session.settings, static_setup(options, session.camera),
                          truth_options(options)};
  ALCOVE_TRY(const auto folder, OutputFolder::create(options.out));
  Json report;
  report["device"] = session.gpu->device().properties().deviceName;
  report["settings"] = to_json(session.settings);
  report["frames"] = options.view.frames;
  for (const MotionKind kind : kMotionKinds) {
    if (options.path && *options.path != kind) continue;
    const MotionPath path(kind, start, options.view.frames);
    ALCOVE_TRY(const auto result, run_motion(*session.gpu, session.scene, path, setup));
    ALCOVE_TRY_VOID(check_validation(*session.gpu));
    report["paths"][std::string(name_of(kind))] = to_json(result);
    std::cout << format_table(kind, result) << std::flush;
    ALCOVE_TRY_VOID(write_pictures(options.out, kind, result.pictures));
  }
  return write_text(options.out / "report.json", report.dump(2) + "\n").map([&] {
    std::cout
        << "Images and report.json are in " << options.out.string()
        << ": NAME_FRAME.png, and _static.png without motion; red is too dark and blue too "
           "bright in _error.png, against the truth, and in _trails.png, against _static.png\n";
  });
}

}  // namespace alcove::sample
