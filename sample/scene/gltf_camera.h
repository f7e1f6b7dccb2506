#pragma once

#include <tiny_gltf.h>

#include <vector>

#include "scene/scene.h"

namespace alcove::sample {

// A camera of a file with the way it looks. What it looks at is not known before the scene is: a
// point of a fixed distance would be lost in the rounding of a large eye, or lie far past a small
// scene.
struct PlacedCamera {
  Camera camera;          // its target is not set
  glm::dvec3 forward_ws;  // unit
};

// Adds the camera of a node, where it has one, to `cameras`. Nonsense in it leaves it out with a
// warning in the scene: the triangles are still good.
void add_camera(const tinygltf::Model& model, const tinygltf::Node& node,
                const glm::dmat4& world_from_node, std::vector<PlacedCamera>& cameras,
                Scene& scene);

// The camera with its target as deep as the middle of the scene's bounds, but no nearer than a
// twentieth of their diagonal, nor so near that rounding turns the view by a tenth of a pixel.
[[nodiscard]] Camera aimed(const PlacedCamera& placed, const Bounds& bounds_ws);

}  // namespace alcove::sample
