#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <optional>

#include "cli/choose_camera.h"
#include "cli/commands.h"
#include "cli/open_session.h"
#include "evaluate/engine_run.h"
#include "evaluate/errors.h"
#include "evaluate/mistakes.h"
#include "gpu/vulkan_device.h"
#include "support/image_io.h"
#include "support/result.h"
#include "support/whole_file.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

Result<void> list_all_devices() {
  ALCOVE_TRY(const auto devices, list_devices());
  bool usable = false;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const DeviceSummary& device = devices[i];
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
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::ranges::replace(text, '\n', ' ');
  return text.empty() ? "nothing" : text;
}

EngineCourse base_course(const Options& options, const Session& session) {
  return {.size = {options.view.width, options.view.height}, .radius = session.settings.radius};
}

// Prints a table of planted mistakes. An error names those that alcoveDiagnose should have named.
Result<void> print_mistakes(const Options& options, const Session& session) {
  ALCOVE_TRY(auto run, MistakeRun::create(*session.gpu, session.scene, session.camera,
                                          base_course(options, session)));
  std::optional<OutputFolder> folder;
  if (!options.pictures.empty()) {
    ALCOVE_TRY(auto pictures, OutputFolder::create(options.pictures));
    folder.emplace(std::move(pictures));
  }
  const auto write = [&](const std::string& name, const Image<float>& picture) {
    return folder && !name.empty()
               ? write_png(std::filesystem::path(options.pictures) / (name + ".png"), picture)
               : Result<void>();
  };
  std::cout << fmt::format("{:<52} {:>5}  {}\n", "mistake", "RMSE", "the library says");
  std::string failed;
  std::array<EngineResult, 2> right;
  for (const bool reversed : {false, true}) {
    ALCOVE_TRY(auto drawn, run.draw_right(reversed));
    std::cout << fmt::format("{:<52} {:>5}  {}\n", reversed ? "none, reversed depth" : "none", "",
                             in_one_line(drawn.said));
    failed = drawn.said.empty() ? failed : "frames without a mistake";
    right.at(reversed ? 1 : 0) = std::move(drawn);
  }
  auto written = write("right", right[0].visibility);
  for (const PlantedMistake& mistake : planted_mistakes()) {
    auto drawn = run.draw(mistake, 0);
    if (!drawn) return Failure(std::string(mistake.name) + ": " + drawn.error());
    const bool refused = drawn->visibility.empty();
    written = written && !refused ? write(mistake.picture, drawn->visibility) : written;
    const Image<float>& expected = right.at(mistake.reversed ? 1 : 0).visibility;
    const Mask all(expected.width, expected.height, 1);
    std::cout << fmt::format(
        "{:<52} {:>5}  {}\n", mistake.name,
        refused ? "" : fmt::format("{:.3f}", compare_images(drawn->visibility, expected, all).rmse),
        in_one_line(drawn->said));
    if (!names(drawn->said, mistake))
      failed += (failed.empty() ? "" : "; ") + std::string(mistake.name);
  }
  if (!written) return written;
  if (!failed.empty())
    return Failure("alcoveDiagnose does not say what it promises of: " + failed + ".");
  return {};
}

// Prints the output of alcoveDiagnose for frames of a scene without mistakes. It should be empty.
Result<void> check_scene(const Options& options, const Session& session) {
  std::vector<std::string> names{options.view.camera};
  if (options.view.camera.empty() && !options.view.eye && !options.view.target) {
    names.clear();
    for (const Camera& camera : session.scene.cameras) names.push_back(camera.name);
    if (names.empty()) names.emplace_back();  // the default view
  }
  bool reported = false;
  for (const std::string& name : names) {
    ViewOptions view = options.view;
    view.camera = name;
    const auto camera = choose_camera(view, session.scene);
    if (!camera) return Failure(camera.error());
    EngineCourse course = base_course(options, session);
    course.quick = true;
    for (const RightCourse& right : right_courses(course)) {
      auto run = EngineRun::create(*session.gpu, session.scene, *camera, right.course);
      const auto said = run ? diagnose_right_frames(**run) : Failure(run.error());
      if (!said) return Failure(said.error());
      std::cout << fmt::format("camera \"{}\", {}: {}\n", name, right.name, in_one_line(*said));
      reported = reported || !said->empty();
    }
  }
  return reported
             ? Result<void>(Failure("alcoveDiagnose reports mistakes in frames that have none."))
             : Result<void>();
}

}  // namespace

Result<void> run_doctor(const Options& options) {
  if (!options.mistakes && options.scene.empty()) return list_all_devices();
  Options of_scene = options;
  if (options.mistakes) {
    of_scene.scene.clear();
    if (options.view.camera.empty() && !options.view.eye && !options.view.target) {
      // The camera "plant" looks down at surfaces of many directions. In a level view of walls and
      // floors that are parallel to its axes, a wrong angle of view cannot be detected.
      of_scene.view.camera = "plant";
    }
  }
  ALCOVE_TRY(const auto session, open_session(of_scene));
  return options.mistakes ? print_mistakes(options, session) : check_scene(options, session);
}

}  // namespace alcove::sample
