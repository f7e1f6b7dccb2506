#include "render/session.h"

#include <chrono>
#include <iostream>
#include <utility>

#include "cli/camera_of.h"
#include "cli/settings.h"
#include "scene/load_scene.h"
#include "support/progress.h"

namespace alcove::sample {

using Failure = tl::unexpected<std::string>;

tl::expected<std::unique_ptr<Gpu>, std::string> open_gpu(
    const Options& options, const std::vector<const char*>& surface_extensions) {
  framegraph::ExecutorOptions executor;
  executor.verify = executor.verify || options.validation;
  executor.check_uses = executor.check_uses || options.validation;
  return Gpu::create({.validation = options.validation,
                      .index = options.device,
                      .surface_extensions = surface_extensions},
                     executor);
}

tl::expected<Session, std::string> load_session(const Options& options) {
  Session session;
  const auto start = std::chrono::steady_clock::now();
  auto scene = load_scene(options.scene, options.materials, print_progress("loading"));
  session.load_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!scene) {
    return Failure(std::move(scene.error()));
  }
  session.scene = std::move(*scene);
  for (const std::string& warning : session.scene.warnings) {
    std::cerr << "note: " << warning << "\n";
  }
  const auto camera = camera_of(options.view, session.scene);
  if (!camera) {
    return Failure(camera.error());
  }
  session.camera = *camera;
  const auto settings = occlusion_settings(options.occlusion, session.scene);
  if (!settings) {
    return Failure(settings.error());
  }
  session.settings = *settings;
  return session;
}

tl::expected<Session, std::string> session_of(const Options& options,
                                              const std::vector<const char*>& surface_extensions) {
  auto session = load_session(options);
  if (!session) {
    return session;
  }
  auto gpu = open_gpu(options, surface_extensions);
  if (!gpu) {
    return Failure(std::move(gpu.error()));
  }
  session->gpu = std::move(*gpu);
  return session;
}

tl::expected<void, std::string> check_validation(const Gpu& gpu) {
  for (const std::string& message : gpu.device().validation_messages()) {
    return Failure("The validation layer says: " + message);
  }
  return {};
}

}  // namespace alcove::sample
