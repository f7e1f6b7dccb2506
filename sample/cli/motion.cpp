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
#include "support/whole_file.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;
using Done = tl::expected<void, std::string>;
using Json = nlohmann::ordered_json;

// What all paths of a run share.
struct Course {
  Session session;
  MotionStart start;
  MotionSetup setup;
};

tl::expected<Course, std::string> course_of(const Options& options) {
  auto session = open_session(options);
  if (!session) {
    return Failure(std::move(session.error()));
  }
  Course course{std::move(*session), {}, {}};
  const passes::OcclusionSettings& settings = course.session.settings;
  if (settings.history_frames == 0) {
    return Failure(
        "The occlusion keeps no history, so there is nothing to follow in motion: give another "
        "--quality, or --set history_frames=32.");
  }
  const auto rays = RayScene::create(course.session.scene);
  if (!rays) {
    return Failure(rays.error());
  }
  const float aspect =
      static_cast<float>(options.view.width) / static_cast<float>(options.view.height);
  auto start = motion_start(*rays, course.session.camera, aspect, settings.radius);
  if (!start) {
    return Failure(std::move(start.error()));
  }
  course.start = std::move(*start);
  course.setup = {settings,
                  options.occlusion.normals,
                  options.view.width,
                  options.view.height,
                  options.occlusion.spp,
                  options.use_cache ? TruthCache::default_folder() : std::filesystem::path(),
                  print_progress};
  return course;
}

Done write_pictures(const std::filesystem::path& folder, MotionKind kind,
                    const std::vector<MotionPicture>& pictures) {
  for (const MotionPicture& picture : pictures) {
    const std::string name = fmt::format("{}_{}", name_of(kind), picture.frame);
    auto written =
        write_png(folder / (name + ".png"), picture.visibility)
            .and_then([&] { return write_png(folder / (name + "_still.png"), picture.still); })
            .and_then([&] {
              return write_png(folder / (name + "_error.png"),
                               error_colours(picture.visibility, picture.truth));
            })
            .and_then([&] {
              return write_png(folder / (name + "_trails.png"),
                               error_colours(picture.visibility, picture.still));
            });
    if (!written) {
      return written;
    }
  }
  return {};
}

Json to_json(const ErrorPair& errors) {
  return {{"pixels", errors.pixels},
          {"moving", errors.moving},
          {"still", errors.still},
          {"ratio", errors.ratio()}};
}

ErrorPair degrees(const ErrorPair& radians) {
  return {radians.pixels, glm::degrees(radians.moving), glm::degrees(radians.still)};
}

Json to_json(const MotionReport& report) {
  return {{"px_per_frame",
           {{"mean", report.speed.mean}, {"percentile_95", report.speed.percentile_95}}},
          {"all", to_json(report.all)},
          {"uncovered", to_json(report.uncovered)},
          {"entered", to_json(report.entered)},
          {"passed_by", to_json(report.passed_by)},
          {"bent_normals_degrees", to_json(degrees(report.bent_normals))},
          {"flicker",
           {{"with_history", report.flicker.with_history},
            {"without", report.flicker.without},
            {"searches", report.flicker.searches},
            {"still", report.flicker.still},
            {"truth", report.flicker.truth},
            {"ratio", report.flicker.ratio()},
            {"ratio_to_searches", report.flicker.ratio_to_searches()}}},
          {"weave", {{"moving", to_json(report.weave)}, {"still", to_json(report.static_weave)}}}};
}

Json to_json(const CutReport& report) {
  Json after = Json::array();
  for (const CutErrors& errors : report.after) {
    after.push_back(
        {{"frames", errors.frames}, {"untold", errors.untold}, {"restart", errors.restart}});
  }
  return {{"after", after}};
}

std::string error_row(const std::string& name, const ErrorPair& errors, int digits = 4) {
  if (errors.pixels == 0) {
    return fmt::format("  {:34}none\n", name);
  }
  return fmt::format("  {:34}{:6.{}f}   {:6.{}f}{:8.2f}{:10}\n", name, errors.moving, digits,
                     errors.still, digits, errors.ratio(), errors.pixels);
}

std::string table_of(MotionKind kind, const MotionReport& report) {
  const std::string ago = fmt::format("{} frames ago", kUncoveredFrames);
  const Flicker& flicker = report.flicker;
  return fmt::format(
             "{}, {:.1f} pixels a frame in the mean, 95 % within {:.1f}\n"
             "  RMSE against ray-traced truth     moving   still   ratio    pixels\n",
             name_of(kind), report.speed.mean, report.speed.percentile_95) +
         error_row("whole frames", report.all) + error_row("uncovered " + ago, report.uncovered) +
         error_row("entered the image " + ago, report.entered) +
         (report.passed_by.pixels > 0 ? error_row("near what moves", report.passed_by) : "") +
         error_row("bent normals, degrees", degrees(report.bent_normals), 2) +
         fmt::format(
             "  change of visibility a frame      {:.4f} with history; standing still {:.4f}; the "
             "truth's own at least {:.4f}\n"
             "    of the searches alone           {:.4f}: ratio {:.3f}\n"
             "    filtered, without history       {:.4f}: ratio {:.3f}\n"
             "  Moving: {}  Still: {}",
             flicker.with_history, flicker.still, flicker.truth, flicker.searches,
             flicker.ratio_to_searches(), flicker.without, flicker.ratio(),
             weave_line(report.weave), weave_line(report.static_weave));
}

std::string table_of(const CutReport& report) {
  std::string out = "cut, RMSE after so many frames       untold   begun anew\n";
  for (const CutErrors& errors : report.after) {
    out += fmt::format("  {:<34}{:.4f}   {:.4f}\n", errors.frames, errors.untold, errors.restart);
  }
  return out;
}

// Draws one path and tells of it, on stdout and in `report`.
Done run_path(Course& course, MotionKind kind, const Options& options, Json& report) {
  const MotionPath path(kind, course.start, options.view.frames);
  std::vector<MotionPicture> pictures;
  std::string table;
  if (kind == MotionKind::kCut) {
    auto made = run_cut(*course.session.gpu, course.session.scene, path, course.setup);
    if (!made) {
      return Failure(std::move(made.error()));
    }
    report[std::string(name_of(kind))] = to_json(*made);
    table = table_of(*made);
    pictures = std::move(made->pictures);
  } else {
    auto made = run_motion(*course.session.gpu, course.session.scene, path, course.setup);
    if (!made) {
      return Failure(std::move(made.error()));
    }
    report[std::string(name_of(kind))] = to_json(*made);
    table = table_of(kind, *made);
    pictures = std::move(made->pictures);
  }
  if (auto valid = check_validation(*course.session.gpu); !valid) {
    return valid;
  }
  std::cout << table << std::flush;
  return write_pictures(options.out, kind, pictures);
}

}  // namespace

Done run_motion(const Options& options) {
  auto course = course_of(options);
  if (!course) {
    return Failure(std::move(course.error()));
  }
  const auto folder = OutputFolder::create(options.out);
  if (!folder) {
    return tl::unexpected(folder.error());
  }
  Json report;
  report["device"] = course->session.gpu->device().properties().deviceName;
  report["settings"] = to_json(course->setup.occlusion);
  report["frames"] = options.view.frames;
  for (const MotionKind kind : kMotionKinds) {
    if (options.path && *options.path != kind) {
      continue;
    }
    if (auto done = run_path(*course, kind, options, report["paths"]); !done) {
      return done;
    }
  }
  return write_text(options.out / "report.json", report.dump(2) + "\n").map([&] {
    std::cout << "Images and report.json are in " << options.out.string()
              << ": NAME_FRAME.png and, the camera standing there, _still.png; as colours, red too "
                 "dark and blue too bright, _error.png against the truth and _trails.png against "
                 "_still.png\n";
  });
}

}  // namespace alcove::sample
