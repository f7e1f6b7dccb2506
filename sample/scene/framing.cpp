#include "scene/framing.h"

#include <algorithm>

namespace alcove::sample {
namespace {

// Bounds that enclose the core at a distance, such as those of a sky dome or a room. The eye should
// stand within them.
std::vector<Bounds> shells_around_core(const Scene& scene) {
  constexpr double kLarger = 4.0;  // than the diagonal of the core
  const Bounds& core = scene.core_bounds_ws;
  const glm::vec3 centre = 0.5f * (core.low + core.high);
  std::vector<Bounds> shells;
  for (const MeshInstance& instance : instances_of(scene.meshes)) {
    const Bounds& bounds = instance.bounds_ws;
    const glm::vec3 size = bounds.high - bounds.low;
    const double shortest = std::min({size.x, size.y, size.z});
    if (diagonal(bounds) > kLarger * diagonal(core) && 2.0 * shortest > diagonal(core) &&
        contains(bounds, centre)) {
      shells.push_back(bounds);
    }
  }
  return shells;
}

}  // namespace

Camera framing_camera(const Scene& scene) {
  const Bounds& core = scene.core_bounds_ws;
  const glm::vec3 centre = 0.5f * (core.low + core.high);
  const float radius = std::max(static_cast<float>(0.5 * diagonal(core)), 1e-6f);
  Camera camera;
  camera.name = "frame";
  camera.origin = scene.origin;
  camera.fov_y = glm::radians(45.0f);
  const float distance = 1.05f * radius / std::sin(0.5f * camera.fov_y);
  camera.target_ws = centre;
  camera.near_plane = 0.02f * radius;
  camera.far_plane =
      distance + 4.0f * std::max(radius, static_cast<float>(diagonal(scene.bounds_ws)));
  camera.fit_planes = true;
  const std::vector<Bounds> shells = shells_around_core(scene);
  constexpr glm::vec3 kSides[] = {
      {0.6f, 0.45f, 0.85f}, {-0.85f, 0.45f, 0.6f}, {-0.6f, 0.45f, -0.85f}, {0.85f, 0.45f, -0.6f}};
  const auto eye_at = [&](const glm::vec3& side) {
    return centre + distance * glm::normalize(side);
  };
  camera.eye_ws = eye_at(kSides[0]);
  for (const glm::vec3& side : kSides) {
    const glm::vec3 eye = eye_at(side);
    const auto holds_eye = [&](const Bounds& shell) { return contains(shell, eye); };
    if (!std::ranges::all_of(shells, holds_eye)) continue;
    camera.eye_ws = eye;
    break;
  }
  return camera;
}

}  // namespace alcove::sample
