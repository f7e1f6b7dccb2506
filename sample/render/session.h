#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "alcove/passes/occlusion.h"
#include "cli/options.h"
#include "render/gpu.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace alcove::sample {

// What the options of a command ask for, before anything is drawn.
struct Session {
  Scene scene;
  Camera camera;
  passes::OcclusionSettings settings;
  double load_seconds = 0.0;  // of the scene
  std::unique_ptr<Gpu> gpu;
};

// Loads the scene and finds camera and settings, without a device. The scene's warnings go to
// stderr as notes, and so does progress where loading takes long.
[[nodiscard]] tl::expected<Session, std::string> load_session(const Options& options);

// load_session(), then opens the device: the cheapest mistake is told first. `surface_extensions`
// are those of a window to present to.
[[nodiscard]] tl::expected<Session, std::string> session_of(
    const Options& options, const std::vector<const char*>& surface_extensions = {});

// The device that the options name, opened anew: what is drawn on it has histories of its own.
[[nodiscard]] tl::expected<std::unique_ptr<Gpu>, std::string> open_gpu(
    const Options& options, const std::vector<const char*>& surface_extensions = {});

// One sentence where the validation layers said anything.
[[nodiscard]] tl::expected<void, std::string> check_validation(const Gpu& gpu);

}  // namespace alcove::sample
