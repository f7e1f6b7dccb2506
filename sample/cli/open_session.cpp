#include "cli/open_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <utility>

#include "cli/choose_camera.h"
#include "cli/settings.h"
#include "scene/framing.h"
#include "scene/load_scene.h"
#include "support/progress.h"

namespace alcove::sample {

namespace {

void print_note(const std::string& note) { std::cerr << "note: " << note << "\n"; }

// Prints the notes about a scene, at most the first twenty, because a file may cause any number.
void print_notes(const std::vector<std::string>& notes) {
  constexpr std::size_t kMost = 20;
  for (std::size_t i = 0; i < std::min(notes.size(), kMost); ++i) print_note(notes[i]);
  if (notes.size() > kMost)
    print_note(fmt::format("There are {} more notes on this scene.", notes.size() - kMost));
}

}  // namespace

Result<Session> load_session(const Options& options) {
  Session session;
  session.device = {options.device, options.validation};
  const auto start = std::chrono::steady_clock::now();
  auto scene = load_scene(options.scene, options.materials, print_progress("loading"));
  session.load_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!scene) return Failure(std::move(scene.error()));
  session.scene = std::move(*scene);
  const ViewFinder finder(session.scene);
  ALCOVE_TRY(session.camera, choose_camera(options.view, finder));
  const double aspect = static_cast<double>(options.view.width) / options.view.height;
  const RadiusChoice radius = finder.radius(session.camera, aspect);
  const std::string source = radius_source(options.occlusion);
  session.radius_reason = source.empty() ? radius.reason : source;
  // `compare` refuses a view of nothing, and says the same.
  const std::string advice = options.command == Command::compare ? "" : radius.advice;
  std::string replaced;
  if (uses_default_camera(options.view) && !session.scene.cameras.empty() &&
      session.camera.name == ViewFinder::kFrame) {
    const std::string& name = session.scene.cameras.front().name;
    replaced = fmt::format(
        "The first camera of the scene, \"{}\", shows nothing, and everything is framed instead; "
        "--camera \"{}\" takes it.",
        name, name);
  }
  for (const std::string& note : {finder.left_out(), advice, replaced})
    if (!note.empty()) session.scene.warnings.insert(session.scene.warnings.begin(), note);
  print_notes(session.scene.warnings);
  ALCOVE_TRY(session.settings, occlusion_settings(options.occlusion, radius.radius));
  print_notes(ineffective_changes(options.occlusion, session.settings));
  return session;
}

Result<Session> open_session(const Options& options,
                             const std::vector<const char*>& surface_extensions) {
  auto session = load_session(options);
  if (!session) return session;
  session->device.surface_extensions = surface_extensions;
  ALCOVE_TRY(auto gpu, open_gpu(session->device));
  session->gpu = std::move(gpu);
  return session;
}

Result<Rendering> render(const Options& options) {
  ALCOVE_TRY(auto environment, load_environment(options.environment, print_note));
  ALCOVE_TRY(auto session, open_session(options));
  std::string origin =
      fmt::format("Radius {}: {}\n", session.settings.radius, session.radius_reason);
  if (uses_default_camera(options.view) && session.camera.name != ViewFinder::kFrame)
    origin += fmt::format("Camera \"{}\" of the scene; --camera none frames everything\n",
                          session.camera.name);
  auto rendering = render(std::move(session), options.view,
                          {options.occlusion.roughness, std::move(environment), options.lit});
  if (rendering && shows_surfaces(*rendering)) std::cout << origin;
  return rendering;
}

Result<SettingTimes> setting_times(const Options& options, const Session& session) {
  if (options.clock == Clock::modelled) {
    return modelled_times(*options.gpu,
                          {.width = options.target_width,
                           .height = options.target_height,
                           .normals = options.view.normals != NormalSource::depth},
                          !options.no_cache);
  }
  StaticSetup setup{options.view, session.camera};
  const double pixels = static_cast<double>(setup.width) * setup.height;
  if (options.clock == Clock::processor) {
    // A software device takes seconds for an image of the target size.
    return measured_times(session, setup, options.clock,
                          options.target_width * options.target_height / pixels);
  }
  setup.width = options.target_width;
  setup.height = options.target_height;
  return measured_times(session, setup, options.clock, 1.0);
}

std::string clock_text(const Options& options, const Session& session) {
  const std::string size = fmt::format("{}x{}", options.target_width, options.target_height);
  if (options.clock == Clock::modelled)
    return fmt::format("modelled time at {} on {}", size, options.gpu->title);
  const char* device = session.gpu->device().properties().deviceName;
  if (options.clock == Clock::timestamps) return fmt::format("GPU time at {} on {}", size, device);
  return fmt::format("processor time on {}, measured at {}x{} and scaled to {}", device,
                     options.view.width, options.view.height, size);
}

TruthOptions truth_options(const Options& options) {
  return {options.occlusion.spp, options.lit_points, !options.no_cache};
}

}  // namespace alcove::sample
