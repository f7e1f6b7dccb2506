#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "alcove/passes/occlusion.h"
#include "gpu/gpu.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace alcove::sample {

// The Vulkan device to open, and its options.
struct DeviceRequest {
  int index = -1;           // As `alcove doctor` lists them; -1 chooses the first suitable one.
  bool validation = false;  // Turns on the validation layers and the checks of the render graph.
  std::vector<const char*> surface_extensions;  // Instance extensions of a window, if any.
  bool capture = false;                         // As DeviceOptions::capture.
};

// A scene with a camera, settings and a device to draw it on.
struct Session {
  Scene scene;
  Camera camera;
  passes::OcclusionSettings settings;
  double load_seconds = 0.0;  // Of the scene.
  DeviceRequest device;
  std::unique_ptr<Gpu> gpu;
};

// Opens the device. Each call creates a new Gpu with its own histories.
[[nodiscard]] tl::expected<std::unique_ptr<Gpu>, std::string> open_gpu(
    const DeviceRequest& request);

// Returns an error with the first message if the validation layers reported any.
[[nodiscard]] tl::expected<void, std::string> check_validation(const Gpu& gpu);

}  // namespace alcove::sample
