#include "render/triangles.h"

#include "scene/area.h"
#include "scene/tangents.h"

namespace alcove::sample {
namespace {

void append_mesh(const Mesh& mesh, const Material& material, std::vector<Vertex>& vertices) {
  std::vector<glm::vec4> tangents(mesh.indices.size(), glm::vec4(0.0f));
  if (material.normal_texture.image >= 0) {
    tangents = corner_tangents(mesh, material.normal_texture);
  }
  for (std::size_t first = 0; first + 2 < mesh.indices.size(); first += 3) {
    const glm::dvec3 area = area_of(mesh, first);
    const double length = glm::length(area);
    if (!(length > 0.0)) {
      continue;
    }
    for (std::size_t i = first; i < first + 3; ++i) {
      const uint32_t v = mesh.indices[i];
      const MeshUvs uvs = uvs_at(mesh, v);
      vertices.push_back({.position_ws = mesh.positions_ws[v],
                          .normal_ws = mesh.normals_ws[v],
                          .face_normal_ws = glm::vec3(area / length),
                          .tangent_ws = tangents[i],
                          .base_color_uv = texture_uv(material.base_color_texture, uvs),
                          .metal_roughness_uv = texture_uv(material.metal_roughness_texture, uvs),
                          .emissive_uv = texture_uv(material.emissive_texture, uvs),
                          .normal_uv = texture_uv(material.normal_texture, uvs)});
    }
  }
}

}  // namespace

Triangles flatten(const Scene& scene) {
  Triangles triangles;
  for (const Mesh& mesh : scene.meshes) {
    const auto first = static_cast<uint32_t>(triangles.vertices.size());
    append_mesh(mesh, scene.materials[mesh.material], triangles.vertices);
    const auto count = static_cast<uint32_t>(triangles.vertices.size()) - first;
    if (count > 0) {
      triangles.draws.push_back({first, count, mesh.material, mesh.moves});
    }
  }
  return triangles;
}

}  // namespace alcove::sample
