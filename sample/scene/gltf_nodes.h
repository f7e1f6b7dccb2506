#pragma once

#include <tiny_gltf.h>

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "scene/gltf_camera.h"
#include "scene/gltf_mesh.h"
#include "scene/scene.h"
#include "support/progress.h"

namespace alcove::sample {

// Adds the meshes and cameras of the nodes of the default scene, or of all nodes where the file has
// no scenes. Sets Scene::origin first where the scene stands so far from the origin of the file
// that floats would round its shapes, and places everything relative to it.
//
// A mesh that several nodes have, or one with EXT_mesh_gpu_instancing, becomes one mesh with
// instances; any other is moved to world space. Skinned meshes take the pose of their joints and
// are moved to world space. `progress` is told the share of the nodes that are read. Errors are
// the end of a sentence.
[[nodiscard]] tl::expected<void, std::string> add_nodes(const tinygltf::Model& model,
                                                        MeshBudget& budget,
                                                        std::vector<PlacedCamera>& cameras,
                                                        Scene& scene, const Progress& progress);

}  // namespace alcove::sample
