#include "triangles.h"

namespace alcove::sample {
namespace {

void append_triangle(const Mesh& mesh, std::size_t first_index, std::vector<Vertex>& vertices) {
  const uint32_t* corner = &mesh.indices[first_index];
  const glm::vec3 a = mesh.positions_ws[corner[0]];
  const glm::vec3 b = mesh.positions_ws[corner[1]];
  const glm::vec3 c = mesh.positions_ws[corner[2]];
  // In double: the cross product of a sliver's sides cancels.
  const glm::dvec3 area = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
  const double length = glm::length(area);
  if (!(length > 0.0)) {
    return;
  }
  const glm::vec3 face_normal(area / length);
  for (int i = 0; i < 3; ++i) {
    vertices.push_back({mesh.positions_ws[corner[i]], mesh.normals_ws[corner[i]], face_normal,
                        mesh.uvs[corner[i]]});
  }
}

}  // namespace

Triangles flatten(const Scene& scene) {
  Triangles triangles;
  for (const Mesh& mesh : scene.meshes) {
    const auto first = static_cast<uint32_t>(triangles.vertices.size());
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      append_triangle(mesh, i, triangles.vertices);
    }
    const auto count = static_cast<uint32_t>(triangles.vertices.size()) - first;
    if (count > 0) {
      triangles.draws.push_back({first, count, mesh.material, mesh.moves});
    }
  }
  return triangles;
}

}  // namespace alcove::sample
