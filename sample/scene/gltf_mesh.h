#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <string>
#include <tl/expected.hpp>

#include "scene/scene.h"

namespace alcove::sample {

// What may still be made of a file, so that a small one cannot ask for all memory by naming the
// same data again and again. What is read is taken from it, whether or not anything comes of it.
struct MeshBudget {
  uint64_t primitives;
  uint64_t vertices;
  uint64_t indices;
};

// Adds the triangles of one primitive, moved to world space, as a mesh. Nothing is added for points
// and lines (a warning) or where no triangle has an area. A mirroring transform turns the winding.
// Errors are the end of a sentence.
[[nodiscard]] tl::expected<void, std::string> add_primitive(const tinygltf::Model& model,
                                                            const tinygltf::Primitive& primitive,
                                                            const std::string& name,
                                                            const glm::dmat4& world_from_mesh,
                                                            MeshBudget& budget, Scene& scene);

}  // namespace alcove::sample
