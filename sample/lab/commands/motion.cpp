#include <fmt/format.h>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/open_session.h"
#include "evaluate/errors.h"
#include "evaluate/motion_run.h"
#include "reference/truth_cache.h"
#include "render/settings_json.h"
#include "support/image_io.h"
#include "support/progress.h"
#include "support/result.h"
#include "support/whole_file.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;
using Json = nlohmann::ordered_json;

// The inputs that all paths of a run share.
struct MotionInputs {
  Session session;
  MotionStart start;
  MotionSetup setup;
};

Result<MotionInputs> motion_inputs(const Options& options) {
  ALCOVE_TRY(auto session, open_session(options));
  MotionInputs inputs{std::move(session), {}, {}};
  const passes::OcclusionSettings& settings = inputs.session.settings;
  if (settings.history_frames == 0) {
    return Failure(
        "The occlusion keeps no history, so there is nothing to follow in motion: give another "
        "--quality, or --set history_frames=32.");
  }
  ALCOVE_TRY(const auto rays, RayScene::create(inputs.session.scene));
  const float aspect =
      static_cast<float>(options.view.width) / static_cast<float>(options.view.height);
  ALCOVE_TRY(auto start, motion_start(rays, inputs.session.camera, aspect, settings.radius));
  inputs.start = std::move(start);
  inputs.setup = {settings,
                  options.occlusion.normals,
                  options.view.width,
                  options.view.height,
                  options.occlusion.spp,
                  options.use_cache ? TruthCache::default_folder() : std::filesystem::path(),
                  print_progress};
  return inputs;
}

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

ErrorPair degrees(const ErrorPair& radians) {
  return {radians.pixels, glm::degrees(radians.moving), glm::degrees(radians.static_camera)};
}

Json to_json(const MotionReport& report) {
  return {{"px_per_frame",
           {{"mean", report.speed.mean}, {"percentile_95", report.speed.percentile_95}}},
          {"all", to_json(report.all)},
          {"uncovered", to_json(report.uncovered)},
          {"entered", to_json(report.entered)},
          {"near_object", to_json(report.near_object)},
          {"bent_normals_degrees", to_json(degrees(report.bent_normals))},
          {"flicker",
           {{"with_history", report.flicker.with_history},
            {"without_history", report.flicker.without_history},
            {"raw", report.flicker.raw},
            {"static", report.flicker.static_camera},
            {"truth", report.flicker.truth},
            {"ratio", report.flicker.ratio()},
            {"ratio_to_raw", report.flicker.ratio_to_raw()}}},
          {"weave", {{"moving", to_json(report.weave)}, {"static", to_json(report.static_weave)}}}};
}

Json to_json(const CutReport& report) {
  Json after = Json::array();
  for (const CutErrors& errors : report.after) {
    after.push_back(
        {{"frames", errors.frames}, {"kept", errors.kept}, {"restarted", errors.restarted}});
  }
  return {{"after", after}};
}

std::string error_row(const std::string& name, const ErrorPair& errors, int digits = 4) {
  if (errors.pixels == 0) return fmt::format("  {:34}none\n", name);
  return fmt::format("  {:34}{:6.{}f}   {:6.{}f}{:8.2f}{:10}\n", name, errors.moving, digits,
                     errors.static_camera, digits, errors.ratio(), errors.pixels);
}

std::string table_of(MotionKind kind, const MotionReport& report) {
  const std::string ago = fmt::format("{} frames ago", kUncoveredFrames);
  const Flicker& flicker = report.flicker;
  return fmt::format(
             "{}: surfaces move by {:.1f} pixels per frame on average, 95 % by at most {:.1f}\n"
             "  RMSE against ray-traced truth     moving   static  ratio    pixels\n",
             name_of(kind), report.speed.mean, report.speed.percentile_95) +
         error_row("whole frames", report.all) + error_row("uncovered " + ago, report.uncovered) +
         error_row("entered the image " + ago, report.entered) +
         (report.near_object.pixels > 0 ? error_row("near the moving object", report.near_object)
                                        : "") +
         error_row("bent normals, degrees", degrees(report.bent_normals), 2) +
         fmt::format(
             "  change of visibility per frame    {:.4f} with history; {:.4f} without motion; the "
             "truth changes by at least {:.4f}\n"
             "    raw occlusion                   {:.4f}: ratio {:.3f}\n"
             "    filtered, without history       {:.4f}: ratio {:.3f}\n"
             "  Moving: {}  Static: {}",
             flicker.with_history, flicker.static_camera, flicker.truth, flicker.raw,
             flicker.ratio_to_raw(), flicker.without_history, flicker.ratio(),
             weave_line(report.weave), weave_line(report.static_weave));
}

std::string table_of(const CutReport& report) {
  std::string out = "cut: RMSE by frames since the cut   kept     restarted history\n";
  for (const CutErrors& errors : report.after)
    out += fmt::format("  {:<34}{:.4f}   {:.4f}\n", errors.frames, errors.kept, errors.restarted);
  return out;
}

// Measures one path; prints the result and adds it to `report`.
Result<void> run_path(MotionInputs& inputs, MotionKind kind, const Options& options, Json& report) {
  const MotionPath path(kind, inputs.start, options.view.frames);
  std::vector<MotionPicture> pictures;
  std::string table;
  if (kind == MotionKind::cut) {
    ALCOVE_TRY(auto made, run_cut(*inputs.session.gpu, inputs.session.scene, path, inputs.setup));
    report[std::string(name_of(kind))] = to_json(made);
    table = table_of(made);
    pictures = std::move(made.pictures);
  } else {
    ALCOVE_TRY(auto made,
               run_motion(*inputs.session.gpu, inputs.session.scene, path, inputs.setup));
    report[std::string(name_of(kind))] = to_json(made);
    table = table_of(kind, made);
    pictures = std::move(made.pictures);
  }
  ALCOVE_TRY_VOID(check_validation(*inputs.session.gpu));
  std::cout << table << std::flush;
  return write_pictures(options.out, kind, pictures);
}

}  // namespace

Result<void> run_motion(const Options& options) {
  ALCOVE_TRY(auto inputs, motion_inputs(options));
  ALCOVE_TRY(const auto folder, OutputFolder::create(options.out));
  Json report;
  report["device"] = inputs.session.gpu->device().properties().deviceName;
  report["settings"] = to_json(inputs.setup.occlusion);
  report["frames"] = options.view.frames;
  for (const MotionKind kind : kMotionKinds) {
    if (options.path && *options.path != kind) continue;
    ALCOVE_TRY_VOID(run_path(inputs, kind, options, report["paths"]));
  }
  return write_text(options.out / "report.json", report.dump(2) + "\n").map([&] {
    std::cout
        << "Images and report.json are in " << options.out.string()
        << ": NAME_FRAME.png, and _static.png without motion; red is too dark and blue too "
           "bright in _error.png, against the truth, and in _trails.png, against _static.png\n";
  });
}

}  // namespace alcove::sample
