#include "scene/area.h"

namespace alcove::sample {

glm::dvec3 area_of(const Mesh& mesh, size_t first) {
  const glm::dvec3 a(mesh.positions[mesh.indices[first]]);
  const glm::dvec3 b(mesh.positions[mesh.indices[first + 1]]);
  const glm::dvec3 c(mesh.positions[mesh.indices[first + 2]]);
  return glm::cross(b - a, c - a);
}

}  // namespace alcove::sample
