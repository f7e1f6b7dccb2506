#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <optional>

#include "cli/camera_of.h"
#include "cli/commands.h"
#include "cli/open_session.h"
#include "evaluate/engine_run.h"
#include "evaluate/mistakes.h"
#include "gpu/vulkan_device.h"
#include "support/whole_file.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

tl::expected<void, std::string> list_all_devices() {
  const auto devices = list_devices();
  if (!devices) {
    return Failure(devices.error());
  }
  bool usable = false;
  for (std::size_t i = 0; i < devices->size(); ++i) {
    const DeviceSummary& device = (*devices)[i];
    std::cout << "device " << i << ": " << device.name << ", " << device.driver << ", Vulkan "
              << VK_API_VERSION_MAJOR(device.api_version) << "."
              << VK_API_VERSION_MINOR(device.api_version) << "\n  "
              << (device.missing.empty() ? "has all that Alcove needs" : "lacks " + device.missing)
              << "\n";
    usable = usable || device.missing.empty();
  }
  if (!usable) {
    return Failure(
        "No Vulkan device has what Alcove needs; install a driver (on Debian, "
        "mesa-vulkan-drivers brings a software one).");
  }
  return {};
}

// The lines of a text without their ends, joined.
std::string in_one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') {
    text.pop_back();
  }
  std::ranges::replace(text, '\n', ' ');
  return text.empty() ? "nothing" : text;
}

tl::expected<std::unique_ptr<EngineRun>, std::string> create_run(const Options& options,
                                                                 const Session& session) {
  return EngineRun::create(*session.gpu, session.scene, {options.view.width, options.view.height});
}

// Prints a table of planted mistakes. An error names those that alcoveDiagnose should have named.
tl::expected<void, std::string> print_mistakes(const Options& options, const Session& session) {
  auto run = create_run(options, session);
  if (!run) {
    return Failure(std::move(run.error()));
  }
  std::optional<OutputFolder> folder;
  if (!options.pictures.empty()) {
    auto made = OutputFolder::create(options.pictures);
    if (!made) {
      return Failure(std::move(made.error()));
    }
    folder.emplace(std::move(*made));
  }
  const auto report =
      draw_mistakes(**run, session.camera, session.settings.radius, options.pictures);
  if (!report) {
    return Failure(report.error());
  }
  std::cout << fmt::format("{:<52} {:>5}  {}\n", "mistake", "RMSE", "alcoveDiagnose says");
  std::cout << fmt::format("{:<52} {:>5}  {}\n", "none", "",
                           in_one_line(report->said_of_right_frames));
  std::string failed = report->said_of_right_frames.empty() ? "" : "frames without a mistake";
  for (const MistakeResult& result : report->results) {
    const bool promised = *result.mistake->sentence != '\0';
    std::cout << fmt::format("{:<52} {:>5.3f}  {}\n", result.mistake->name, result.rmse,
                             in_one_line(result.said));
    if (promised != result.named) {
      failed += (failed.empty() ? "" : "; ") + std::string(result.mistake->name);
    }
  }
  if (!failed.empty()) {
    return Failure("alcoveDiagnose does not say what it promises of: " + failed + ".");
  }
  return {};
}

// Prints the output of alcoveDiagnose for frames of a scene without mistakes. It should be empty.
tl::expected<void, std::string> check_scene(const Options& options, const Session& session) {
  auto run = create_run(options, session);
  if (!run) {
    return Failure(std::move(run.error()));
  }
  std::vector<std::string> names{options.view.camera};
  if (options.view.camera.empty() && !options.view.eye && !options.view.target) {
    names.clear();
    for (const Camera& camera : session.scene.cameras) {
      names.push_back(camera.name);
    }
    if (names.empty()) {
      names.emplace_back();  // the default view
    }
  }
  struct Course {
    const char* name;
    EngineCourse course;
  };
  const Course courses[] = {{"still", {}},
                            {"jittered", {.jitter = true}},
                            {"orbiting", {.orbit = 0.01f, .jitter = true}},
                            {"geometric normals", {.orbit = 0.01f, .geometric = true}}};
  bool reported = false;
  for (const std::string& name : names) {
    ViewOptions view = options.view;
    view.camera = name;
    const auto camera = camera_of(view, session.scene);
    if (!camera) {
      return Failure(camera.error());
    }
    for (const Course& course : courses) {
      const auto drawn = (*run)->draw(*camera, session.settings.radius, course.course);
      if (!drawn) {
        return Failure(drawn.error());
      }
      std::cout << fmt::format("camera \"{}\", {}: {}\n", name, course.name,
                               in_one_line(drawn->said));
      reported = reported || !drawn->said.empty();
    }
  }
  return reported ? tl::expected<void, std::string>(
                        Failure("alcoveDiagnose reports mistakes in frames that have none."))
                  : tl::expected<void, std::string>();
}

}  // namespace

tl::expected<void, std::string> run_doctor(const Options& options) {
  if (!options.mistakes && options.scene.empty()) {
    return list_all_devices();
  }
  Options of_scene = options;
  if (options.mistakes) {
    of_scene.scene.clear();
    if (options.view.camera.empty() && !options.view.eye && !options.view.target) {
      // The camera "plant" looks down at surfaces of many directions. In a level view of walls and
      // floors that are parallel to its axes, a wrong angle of view cannot be detected.
      of_scene.view.camera = "plant";
    }
  }
  const auto session = open_session(of_scene);
  if (!session) {
    return Failure(session.error());
  }
  return options.mistakes ? print_mistakes(options, *session) : check_scene(options, *session);
}

}  // namespace alcove::sample
