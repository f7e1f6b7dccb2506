#pragma once

#include <tiny_gltf.h>

#include <string>

#include "scene/gltf.h"
#include "support/result.h"

namespace alcove::sample {

// The transform of a primitive to world space, or its instances.
struct PrimitivePlacement {
  glm::dmat4 world_from_mesh{1.0};
  const std::vector<glm::dmat4>* joints =
      nullptr;  // joints of a skin; they replace world_from_mesh
  // If not null, the mesh is not transformed and gets these instances.
  const std::vector<glm::mat4x3>* instances = nullptr;
  const std::vector<double>* morph_weights = nullptr;  // by morph target; null: all are 0
};

// Adds the triangles of one primitive as a mesh, with the vertices that they use. Morph targets are
// applied before the placement. Points and lines are left out with a warning. All that is read is
// subtracted from `budget`, even if it is not drawn.
// Triangles without an area, and primitives whose material is alpha-blended with an alpha of 0, are
// left out. A mirroring transform reverses the winding. Error texts are the end of a sentence whose
// beginning the caller adds.
[[nodiscard]] Result<void> add_primitive(const tinygltf::Model& model,
                                         const tinygltf::Primitive& primitive,
                                         const std::string& name,
                                         const PrimitivePlacement& placement, GltfLimits& budget,
                                         Scene& scene);

}  // namespace alcove::sample
