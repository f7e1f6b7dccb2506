#pragma once

#include <tiny_gltf.h>

#include <vector>

#include "scene/scene.h"

namespace alcove::sample {

// A camera of a file and its direction. The camera's target is set later, when the size of the
// scene is known: a target at a fixed distance could be lost in the rounding of a large position,
// or be far behind a small scene.
struct PlacedCamera {
  Camera camera;          // its target is not set
  glm::dvec3 forward_ws;  // unit
};

// Adds the camera of a node to `cameras` if the node has one. An invalid camera is left out with a
// warning in the scene, because the triangles do not depend on it.
void add_camera(const tinygltf::Model& model, const tinygltf::Node& node,
                const glm::dmat4& world_from_node, std::vector<PlacedCamera>& cameras,
                Scene& scene);

// Returns the camera with its target at the depth of the centre of the bounds. The target is at
// least a twentieth of the bounds' diagonal away, and so far that rounding rotates the view by less
// than a tenth of a pixel.
[[nodiscard]] Camera aimed(const PlacedCamera& placed, const Bounds& bounds_ws);

}  // namespace alcove::sample
