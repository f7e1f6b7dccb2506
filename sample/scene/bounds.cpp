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

std::vector<MeshInstance> instances_of(const std::vector<Mesh>& meshes) {
  std::vector<MeshInstance> out;
  for (uint32_t m = 0; m < meshes.size(); ++m) {
    const Mesh& mesh = meshes[m];
    if (mesh.indices.empty()) continue;
    Bounds own = empty_bounds();
    for (const uint32_t i : mesh.indices) own = united(own, {mesh.positions[i], mesh.positions[i]});
    for (uint32_t i = 0; i < instance_count(mesh); ++i) {
      out.push_back({m, i, empty_bounds()});
      for (const glm::vec3& corner : corners_of(own)) {
        const glm::vec3 at = world_from_mesh(mesh, i) * glm::vec4(corner, 1.0f);
        out.back().bounds_ws = united(out.back().bounds_ws, {at, at});
      }
    }
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
