#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

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
    const std::string name = std::string(name_of(kind)) + "_" + std::to_string(picture.frame);
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

void print_row(std::ostream& out, const char* name, const ErrorPair& errors, int digits = 4) {
  out << "  " << std::left << std::setw(34) << name << std::right << std::setprecision(digits);
  if (errors.pixels == 0) {
    out << "none\n";
    return;
  }
  out << std::setw(6) << errors.moving << "   " << std::setw(6) << errors.still
      << std::setprecision(2) << std::setw(8) << errors.ratio() << std::setw(10) << errors.pixels
      << "\n";
}

std::string table_of(MotionKind kind, const MotionReport& report) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(1) << name_of(kind) << ", " << report.speed.mean
      << " pixels a frame in the mean, 95 % within " << report.speed.percentile_95 << "\n"
      << "  RMSE against ray-traced truth     moving   still   ratio    pixels\n";
  print_row(out, "whole frames", report.all);
  const std::string ago = std::to_string(kUncoveredFrames) + " frames ago";
  print_row(out, ("uncovered " + ago).c_str(), report.uncovered);
  print_row(out, ("entered the image " + ago).c_str(), report.entered);
  if (report.passed_by.pixels > 0) {
    print_row(out, "near what moves", report.passed_by);
  }
  print_row(out, "bent normals, degrees", degrees(report.bent_normals), 2);
  const Flicker& flicker = report.flicker;
  out << std::setprecision(4) << "  change of visibility a frame      " << flicker.with_history
      << " with history; standing still " << flicker.still << "; the truth's own at least "
      << flicker.truth << "\n"
      << "    of the searches alone           " << flicker.searches << ": ratio "
      << std::setprecision(3) << flicker.ratio_to_searches() << "\n"
      << "    filtered, without history       " << std::setprecision(4) << flicker.without
      << ": ratio " << std::setprecision(3) << flicker.ratio() << "\n"
      << "  Moving: " << weave_line(report.weave) << "  Still: " << weave_line(report.static_weave);
  return out.str();
}

std::string table_of(const CutReport& report) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(4)
      << "cut, RMSE after so many frames       untold   begun anew\n";
  for (const CutErrors& errors : report.after) {
    out << "  " << std::left << std::setw(34) << errors.frames << std::right << errors.untold
        << "   " << errors.restart << "\n";
  }
  return out.str();
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
