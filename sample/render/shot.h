#pragma once

#include <cstdint>
#include <optional>

#include "alcove/passes/occlusion.h"
#include "scene/camera.h"

namespace alcove::sample {

// A view of a scene and the settings that its occlusion is drawn with.
struct Shot {
  Camera camera;
  passes::OcclusionSettings settings;
  // Perceptual, [0,1], of every surface; null: the materials' own roughness.
  std::optional<float> roughness;
  std::uint32_t width = 0;  // pixels
  std::uint32_t height = 0;
  std::uint32_t frames = 0;  // number of frames to draw; 0: as many as the history averages
};

}  // namespace alcove::sample
