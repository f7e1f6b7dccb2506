#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "support/glm.h"

namespace alcove::sample {

struct Mesh;

// An axis-aligned box. The empty box has low = +infinity and high = -infinity, so that adding a
// point to it yields the box of that point.
struct Bounds {
  glm::vec3 low{0.0f};
  glm::vec3 high{0.0f};
};

[[nodiscard]] Bounds empty_bounds();
// Returns the smallest box that contains both boxes; either may be empty.
[[nodiscard]] Bounds united(const Bounds& a, const Bounds& b);
[[nodiscard]] bool contains(const Bounds& bounds, const glm::vec3& point);
// Returns the length of the diagonal. It is computed in double, because the square of a large float
// overflows.
[[nodiscard]] double diagonal(const Bounds& bounds);
// Returns the corners. Bit c of a corner's index is set if its coordinate c is that of `high`.
[[nodiscard]] std::array<glm::vec3, 8> corners_of(const Bounds& bounds);

// One instance of a mesh with triangles. A mesh whose `instances` is empty has one instance.
struct MeshInstance {
  uint32_t mesh;      // indexes the meshes
  uint32_t instance;  // below instance_count()
  Bounds bounds_ws;   // around the transformed box of the mesh
};
// Returns all instances of all meshes that have triangles, ordered by mesh.
[[nodiscard]] std::vector<MeshInstance> instances_of(const std::vector<Mesh>& meshes);

// Returns the box of all triangles of all instances, or a box of size zero if there are none.
// Vertices that no triangle uses do not count.
[[nodiscard]] Bounds bounds_of(const std::vector<Mesh>& meshes);

}  // namespace alcove::sample
