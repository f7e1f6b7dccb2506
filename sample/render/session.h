#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "gpu/gpu.h"
#include "gpu/occlusion.h"
#include "render/normal_source.h"
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

// How a view of a scene is drawn, whatever its camera.
struct ViewRequest {
  std::uint32_t width = 960;  // pixels
  std::uint32_t height = 540;
  NormalSource normals = NormalSource::shading;
  std::uint32_t frames = 1;  // the last one counts
  float orbit = 0.0f;        // angle in radians by which the camera orbits its target per frame
  double guard_band = 0.0;   // percent of the height, beyond each border, which is not displayed
};

// A view that a command line reproduces. With 0 frames it has as many as the history averages.
struct Shot : ViewRequest {
  Camera camera;
  OcclusionSettings settings;
  // Perceptual, [0,1], of every surface; null: the materials' own roughness.
  std::optional<float> roughness = {};
};

// Opens the device, with the checks of the render graph if it has validation. Each call creates a
// new Gpu with its own histories.
[[nodiscard]] Result<std::unique_ptr<Gpu>> open_gpu(const DeviceOptions& options);

// Returns an error with the first message if the validation layers reported any.
[[nodiscard]] Result<void> check_validation(const Gpu& gpu);

}  // namespace alcove::sample
