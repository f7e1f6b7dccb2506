#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu/gpu.h"
#include "gpu/occlusion.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "support/result.h"

namespace alcove::sample {

// The Vulkan device to open, and its options.
struct DeviceRequest {
  int index = -1;           // As `alcove doctor` lists them; -1 chooses the first suitable one.
  bool validation = false;  // Turns on the validation layers and the checks of the render graph.
  std::vector<const char*> surface_extensions;  // Instance extensions of a window, if any.
};

// A scene with a camera, settings and a device to draw it on.
struct Session {
  Scene scene;
  Camera camera;
  OcclusionSettings settings;
  std::string radius_reason;  // Where the radius comes from.
  double load_seconds = 0.0;  // Of the scene.
  DeviceRequest device;
  std::unique_ptr<Gpu> gpu;
};

// A view of a scene and the settings that its occlusion is drawn with.
struct Shot {
  Camera camera;
  OcclusionSettings settings;
  // Perceptual, [0,1], of every surface; null: the materials' own roughness.
  std::optional<float> roughness;
  std::uint32_t width = 0;  // pixels
  std::uint32_t height = 0;
  std::uint32_t frames = 0;  // number of frames to draw; 0: as many as the history averages
};

// Opens the device. Each call creates a new Gpu with its own histories.
[[nodiscard]] Result<std::unique_ptr<Gpu>> open_gpu(const DeviceRequest& request);

// Returns an error with the first message if the validation layers reported any.
[[nodiscard]] Result<void> check_validation(const Gpu& gpu);

}  // namespace alcove::sample
