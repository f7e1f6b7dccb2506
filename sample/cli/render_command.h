#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "alcove/passes/occlusion.h"
#include "cli/options.h"
#include "scene/camera.h"

namespace alcove::sample {

// A view of a scene and what its occlusion is found with.
struct Shot {
  Camera camera;
  passes::OcclusionSettings settings;
  std::optional<float> roughness;  // over that of the materials
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t frames = 0;  // that are drawn; 0: as many as the history averages
};

// What `alcove render` has to be called with to draw the shot: the program's name, then arguments
// that parse_options reads back. Scene, whether blends are cut out, environment, normals, device
// and the name of the camera are those of `options`.
[[nodiscard]] std::vector<std::string> render_arguments(const Options& options, const Shot& shot);

// The arguments as a line for a POSIX shell, quoted where need be.
[[nodiscard]] std::string shell_line(const std::vector<std::string>& arguments);

}  // namespace alcove::sample
