#include "scene/tangents.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/direction.h"

namespace alcove::sample {
namespace {

// How a triangle lies in a map.
struct Layout {
  glm::dvec3 along_u{0.0};  // unit; zero where the triangle has no area in the map
  bool mirrored = false;    // the map is seen from behind
};

Layout layout_of(const std::array<glm::dvec3, 3>& corners, const std::array<glm::dvec2, 3>& uvs) {
  const glm::dvec2 b = uvs[1] - uvs[0];
  const glm::dvec2 c = uvs[2] - uvs[0];
  const double area = b.x * c.y - b.y * c.x;
  if (!std::isfinite(area) || area == 0.0) return {};
  // v grows downwards in an image, so a triangle that turns left there has a negative area.
  const double sign = area < 0.0 ? -1.0 : 1.0;
  const glm::dvec3 u = (corners[1] - corners[0]) * c.y - (corners[2] - corners[0]) * b.y;
  return {direction_of(sign * u), area > 0.0};
}

double angle_at(const std::array<glm::dvec3, 3>& corners, size_t corner) {
  const glm::dvec3 a = direction_of(corners[(corner + 1) % 3] - corners[corner]);
  const glm::dvec3 b = direction_of(corners[(corner + 2) % 3] - corners[corner]);
  return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
}

std::vector<glm::vec4> given_tangents(const Mesh& mesh) {
  std::vector<glm::vec4> out(mesh.indices.size());
  for (size_t i = 0; i < out.size(); ++i) out[i] = mesh.tangents_ws[mesh.indices[i]];
  return out;
}

}  // namespace

std::vector<glm::vec4> corner_tangents(const Mesh& mesh, const TextureUse& map) {
  if (!mesh.tangents_ws.empty()) return given_tangents(mesh);
  // Of each vertex, seen from in front and from behind.
  using Sides = std::array<glm::dvec3, 2>;
  std::vector<Sides> sums(mesh.positions_ws.size(), Sides{glm::dvec3(0.0), glm::dvec3(0.0)});
  std::vector<char> mirrored(mesh.indices.size());
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    std::array<glm::dvec3, 3> corners;
    std::array<glm::dvec2, 3> uvs;
    for (size_t k = 0; k < 3; ++k) {
      corners[k] = mesh.positions_ws[mesh.indices[i + k]];
      uvs[k] = texture_uv(map, uvs_at(mesh, mesh.indices[i + k]));
    }
    const Layout layout = layout_of(corners, uvs);
    const glm::dvec3 face = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t v = mesh.indices[i + k];
      const glm::dvec3 normal(mesh.normals_ws[v]);
      // Which side the bitangent is on goes by the vertex's normal, wherever the face looks.
      const bool behind = layout.mirrored != (glm::dot(normal, face) < 0.0);
      const glm::dvec3 flat = layout.along_u - normal * glm::dot(normal, layout.along_u);
      mirrored[i + k] = behind;
      sums[v][behind] += direction_of(flat) * angle_at(corners, k);
    }
  }
  std::vector<glm::vec4> out(mesh.indices.size());
  for (size_t i = 0; i < out.size(); ++i) {
    const bool behind = mirrored[i] != 0;
    const glm::vec3 tangent(direction_of(sums[mesh.indices[i]][behind]));
    out[i] = glm::vec4(tangent, behind ? -1.0f : 1.0f);
  }
  return out;
}

}  // namespace alcove::sample
