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

// A scene with a camera, settings and a device to draw it on.
struct Session {
  Scene scene;
  Camera camera;
  OcclusionSettings settings;
  std::string radius_reason;  // Where the radius comes from.
  double load_seconds = 0.0;  // Of the scene.
  DeviceOptions device;
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
  double guard_band = 0.0;   // percent of the height
  std::uint32_t frames = 0;  // number of frames to draw; 0: as many as the history averages
};

// Opens the device, with the checks of the render graph if it has validation. Each call creates a
// new Gpu with its own histories.
[[nodiscard]] Result<std::unique_ptr<Gpu>> open_gpu(const DeviceOptions& options);

// Returns an error with the first message if the validation layers reported any.
[[nodiscard]] Result<void> check_validation(const Gpu& gpu);

}  // namespace alcove::sample
