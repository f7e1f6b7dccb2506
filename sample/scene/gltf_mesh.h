#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <string>
#include <tl/expected.hpp>

#include "scene/scene.h"

namespace alcove::sample {

// What may still be read of a file. It bounds the memory and the time that a small file can ask for
// by naming the same data many times. Everything that is read is subtracted, even if nothing is
// drawn of it.
struct MeshBudget {
  uint64_t primitives;
  uint64_t vertices;
  uint64_t indices;
  uint64_t instances;        // counted once for each primitive of their mesh
  uint64_t joints;           // of all skins
  uint64_t drawn_triangles;  // counted once for each instance
};

// Where a primitive stands in world space.
struct PrimitivePlacement {
  glm::dmat4 world_from_mesh{1.0};
  const std::vector<glm::dmat4>* joints = nullptr;  // of a skin, instead of world_from_mesh
  // The mesh stays in its own space, with these instances.
  const std::vector<glm::mat4x3>* instances = nullptr;
};

// Adds the triangles of one primitive as a mesh. Nothing is added for points and lines (a warning),
// where no triangle has an area, and for a material that blends with an alpha of 0. A mirroring
// transform turns the winding. Errors are the end of a sentence.
[[nodiscard]] tl::expected<void, std::string> add_primitive(const tinygltf::Model& model,
                                                            const tinygltf::Primitive& primitive,
                                                            const std::string& name,
                                                            const PrimitivePlacement& placement,
                                                            MeshBudget& budget, Scene& scene);

}  // namespace alcove::sample
