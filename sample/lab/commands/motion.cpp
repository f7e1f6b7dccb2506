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
  json["px_per_frame"] = report.speed;
  for (std::size_t i = 0; i < report.errors.size(); ++i)
    json[kMotionErrorNames[i]] = to_json(report.errors[i]);
  json["bent_normals_degrees"] = {{"moving", report.bent_normal_degrees},
                                  {"static", report.static_bent_normal_degrees}};
  json["flicker"] = {{"with_history", report.flicker.with_history},
                     {"without_history", report.flicker.without_history},
                     {"ratio", report.flicker.ratio()}};
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
      "{}: surfaces move by {:.1f} pixels per frame on average\n"
      "  RMSE against ray-traced truth     moving   static  ratio    pixels\n",
      name_of(kind), report.speed);
  for (std::size_t i = 0; i < report.errors.size(); ++i) {
    const ErrorPair& errors = report.errors[i];
    if (errors.pixels > 0) {
      out += fmt::format("  {:34}{:6.4f}   {:6.4f}{:8.2f}{:10}\n", kMotionErrorTitles[i],
                         errors.moving, errors.static_camera, errors.ratio(), errors.pixels);
    }
  }
  return out + fmt::format(
                   "  bent normals, mean degrees        {:6.2f}   {:6.2f}\n"
                   "  Change of visibility per frame at the same surface: {:.4f}, without history "
                   "{:.4f}; ratio {:.2f}\n",
                   report.bent_normal_degrees, report.static_bent_normal_degrees,
                   report.flicker.with_history, report.flicker.without_history,
                   report.flicker.ratio());
}

}  // namespace

Result<void> run_motion(const Options& options) {
  ALCOVE_TRY_VOID(create_folder(options.out));
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
  const StaticSetup view{options.view, session.camera};
  const MotionSetup setup{session.settings, view, truth_options(options)};
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
