#pragma once

#include <cstdint>
#include <vector>

#include "scene/bounds.h"

namespace alcove::sample {

// The main content of a scene: the scene without its surroundings, such as sky domes, ground planes
// and stray triangles far away.
struct SceneCore {
  Bounds bounds_ws;
  uint64_t triangles_outside = 0;  // triangles of the scene that were left out of bounds_ws
};

// Finds the bounds of the core in two steps. First it leaves out surroundings (sky domes, ground
// planes): instances that are more than ten times larger than all smaller instances together, and
// that enclose them or are flat. Then it leaves out triangles far from the central 99 %, by number
// and by area, if this makes the bounds at least four times smaller (for example narrow triangles
// far away). If nothing is left out, the result is the bounds of all triangles.
[[nodiscard]] SceneCore scene_core(const std::vector<Mesh>& meshes);

}  // namespace alcove::sample
