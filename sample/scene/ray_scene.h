#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "scene/scene.h"
#include "support/result.h"

namespace alcove::sample {

// A hit of a ray with the scene. Normals are unit and face the ray's origin.
struct Hit {
  float distance;
  uint32_t mesh;  // indexes Scene::meshes
  uint32_t material;
  bool front;  // whether the ray meets the front of the triangle
  glm::vec3 geometric_normal_ws;
  glm::vec3 shading_normal_ws;
  MeshUvs uvs;
  glm::vec4 color;  // of the vertices, linear RGB and alpha
};

// The triangles of a scene in an acceleration structure of Embree. It is immutable, and any thread
// may trace. The scene must outlive it.
class RayScene {
 public:
  // Errors: Embree has no device or no memory; the scene extends further than 1e12 from its origin.
  [[nodiscard]] static Result<RayScene> create(const Scene& scene);
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;
  ~RayScene();

  [[nodiscard]] const Scene& scene() const;

  // Returns the nearest hit. Rays pass through points that the rasteriser does not draw: points
  // below the cutoff of an alpha mask, and back faces of single-sided materials unless
  // `both_sides`.
  [[nodiscard]] std::optional<Hit> nearest(const glm::vec3& origin, const glm::vec3& direction,
                                           float far, bool both_sides = false) const;
  // Whether each of up to 16 rays from one origin hits anything nearer than `far`. Bit i is ray i.
  [[nodiscard]] uint32_t blocked(const glm::vec3& origin, std::span<const glm::vec3> directions,
                                 float far) const;
  // Returns the origin for rays that leave a surface point. It is offset along the normal by
  // sixteen times the rounding error of positions in a scene of this size, so that a flat surface
  // does not occlude itself.
  [[nodiscard]] glm::vec3 off_surface(const glm::vec3& position_ws,
                                      const glm::vec3& normal_ws) const;

 private:
  struct Impl;
  RayScene();
  std::unique_ptr<Impl> impl_;
};

// Linear base colour at a hit.
[[nodiscard]] glm::vec3 albedo_at(const Scene& scene, const Hit& hit);

}  // namespace alcove::sample
