#pragma once

#include <embree3/rtcore.h>

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "reference/truth.h"

namespace alcove::sample {

// A hit of a ray with the scene. Normals are unit and face the ray's origin.
struct Hit {
  float distance;
  uint32_t material;
  glm::vec3 geometric_normal_ws;
  glm::vec3 shading_normal_ws;
  MeshUvs uvs;
  glm::vec4 color;  // of the vertices, linear RGB and alpha
};

// The bounding volume hierarchy that Embree builds over a scene, and the queries of it.
struct RayScene::Impl {
  const Scene* scene = nullptr;
  RTCDevice device = nullptr;
  RTCScene tree = nullptr;
  // The mesh and the instance of each geometry of the tree, by geometry index.
  struct Attached {
    uint32_t mesh;
    uint32_t instance;
  };
  std::vector<Attached> attached;
  struct FilteredMesh {
    const Scene* scene;
    const Mesh* mesh;
  };
  std::vector<FilteredMesh> filtered;  // user data of Embree's filter functions

  ~Impl();
  [[nodiscard]] std::optional<Hit> nearest(const glm::vec3& origin, const glm::vec3& direction,
                                           float far) const;
  // Whether each of up to 16 rays from one origin hits anything nearer than `far`. Bit i is ray i.
  [[nodiscard]] uint32_t blocked(const glm::vec3& origin, std::span<const glm::vec3> directions,
                                 float far) const;
  // Returns the origin for rays that leave a surface point. It is offset along the normal by
  // sixteen times the rounding error of positions in a scene of this size, so that a flat surface
  // does not occlude itself.
  [[nodiscard]] glm::vec3 off_surface(const glm::vec3& position_ws,
                                      const glm::vec3& normal_ws) const;
};

// Linear base colour at a hit.
[[nodiscard]] glm::vec3 albedo_at(const Scene& scene, const Hit& hit);

}  // namespace alcove::sample
