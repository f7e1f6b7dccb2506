#include "scene/bounds.h"

#include <limits>

#include "scene/scene.h"

namespace alcove::sample {

Bounds empty_bounds() {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  return {glm::vec3(kInfinity), glm::vec3(-kInfinity)};
}

Bounds united(const Bounds& a, const Bounds& b) {
  return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

bool contains(const Bounds& bounds, const glm::vec3& point) {
  return glm::all(glm::lessThanEqual(bounds.low, point)) &&
         glm::all(glm::lessThanEqual(point, bounds.high));
}

double diagonal(const Bounds& bounds) {
  return glm::length(glm::dvec3(bounds.high) - glm::dvec3(bounds.low));
}

std::array<glm::vec3, 8> corners_of(const Bounds& bounds) {
  std::array<glm::vec3, 8> corners;
  for (size_t i = 0; i < corners.size(); ++i)
    for (int c = 0; c < 3; ++c) corners[i][c] = (i >> c & 1u) != 0 ? bounds.high[c] : bounds.low[c];
  return corners;
}

Bounds bounds_of_triangles(const Mesh& mesh, size_t first, size_t last) {
  Bounds bounds = empty_bounds();
  for (size_t i = first; i < last; ++i) {
    const glm::vec3& position = mesh.positions[mesh.indices[i]];
    bounds = united(bounds, {position, position});
  }
  return bounds;
}

Bounds transformed(const Bounds& bounds, const glm::mat4x3& transform) {
  Bounds out = empty_bounds();
  for (const glm::vec3& corner : corners_of(bounds)) {
    const glm::vec3 at = transform * glm::vec4(corner, 1.0f);
    out = united(out, {at, at});
  }
  return out;
}

std::vector<MeshInstance> instances_of(const std::vector<Mesh>& meshes) {
  std::vector<MeshInstance> out;
  for (uint32_t m = 0; m < meshes.size(); ++m) {
    const Mesh& mesh = meshes[m];
    if (mesh.indices.empty()) continue;
    const Bounds own = bounds_of_triangles(mesh, 0, mesh.indices.size());
    if (mesh.instances.empty()) out.push_back({m, 0, own});
    for (uint32_t i = 0; i < mesh.instances.size(); ++i)
      out.push_back({m, i, transformed(own, mesh.instances[i])});
  }
  return out;
}

Bounds bounds_of(const std::vector<Mesh>& meshes) {
  Bounds bounds = empty_bounds();
  for (const MeshInstance& instance : instances_of(meshes))
    bounds = united(bounds, instance.bounds_ws);
  return bounds.low.x <= bounds.high.x ? bounds : Bounds{};
}

}  // namespace alcove::sample
