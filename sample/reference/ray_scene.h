#pragma once

#include <embree3/rtcore.h>

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "reference/truth.h"

namespace alcove::sample {

// Where a ray met the scene. Normals are unit and face the ray's origin.
struct Hit {
  float distance;
  uint32_t material;
  glm::vec3 geometric_normal_ws;
  glm::vec3 shading_normal_ws;
  MeshUvs uvs;
};

// Embree's tree over a scene, and the questions that the truths ask of it.
struct RayScene::Impl {
  const Scene* scene = nullptr;
  RTCDevice device = nullptr;
  RTCScene tree = nullptr;

  ~Impl();
  [[nodiscard]] std::optional<Hit> nearest(const glm::vec3& origin, const glm::vec3& direction,
                                           float far) const;
  // Whether each of up to 16 rays from one origin meets anything nearer than `far`; bit i is ray i.
  [[nodiscard]] uint32_t blocked(const glm::vec3& origin, std::span<const glm::vec3> directions,
                                 float far) const;
  // A start for rays that leave a surface: off it by some sixteen times the rounding of positions
  // in a scene of this size, so that a flat surface does not meet itself.
  [[nodiscard]] glm::vec3 off_surface(const glm::vec3& position_ws,
                                      const glm::vec3& normal_ws) const;
};

// Linear base colour at a hit.
[[nodiscard]] glm::vec3 albedo_at(const Scene& scene, const Hit& hit);

}  // namespace alcove::sample
