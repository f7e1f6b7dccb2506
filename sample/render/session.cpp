#include "render/session.h"

#include <iostream>
#include <utility>

#include "alcove/framegraph/verify.h"
#include "cli/camera_of.h"
#include "cli/settings.h"
#include "scene/load_scene.h"

namespace alcove::sample {

using Failure = tl::unexpected<std::string>;

tl::expected<std::unique_ptr<Gpu>, std::string> open_gpu(
    const Options& options, const std::vector<const char*>& surface_extensions) {
  framegraph::ExecutorOptions executor;
  if (options.validation) executor.verify = framegraph::verify;
  executor.check_uses = executor.check_uses || options.validation;
  return Gpu::create({.validation = options.validation,
                      .index = options.device,
                      .surface_extensions = surface_extensions},
                     executor);
}

tl::expected<Session, std::string> session_of(const Options& options,
                                              const std::vector<const char*>& surface_extensions) {
  Session session;
  auto scene = load_scene(options.scene, options.cut_blends);
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
  auto gpu = open_gpu(options, surface_extensions);
  if (!gpu) {
    return Failure(std::move(gpu.error()));
  }
  session.gpu = std::move(*gpu);
  return session;
}

tl::expected<void, std::string> check_validation(const Gpu& gpu) {
  for (const std::string& message : gpu.device().validation_messages()) {
    return Failure("The validation layer says: " + message);
  }
  return {};
}

}  // namespace alcove::sample
