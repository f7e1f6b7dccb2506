#pragma once

#include <tiny_gltf.h>

#include <vector>

#include "scene/gltf_camera.h"
#include "scene/gltf_mesh.h"
#include "scene/scene.h"
#include "support/progress.h"
#include "support/result.h"

namespace alcove::sample {

// Adds the meshes and cameras of the drawn nodes of a file (see read_nodes()). Sets Scene::origin
// first (see chosen_origin()), and places everything relative to it.
//
// A mesh of several nodes, or of a node with EXT_mesh_gpu_instancing, becomes one mesh with
// instances. Other meshes are transformed to world space. Skinned meshes are transformed to world
// space in the pose of their joints. `progress` receives the fraction of the nodes that have been
// read. Error texts are the end of a sentence whose beginning the caller adds.
[[nodiscard]] Result<void> add_nodes(const tinygltf::Model& model, GltfLimits& budget,
                                     std::vector<PlacedCamera>& cameras, Scene& scene,
                                     const Progress& progress);

}  // namespace alcove::sample
