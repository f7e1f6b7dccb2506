#include "scene/framing.h"

#include <algorithm>
#include <cmath>

namespace alcove::sample {
namespace {

// Returns the bounds of meshes that enclose the core at a distance, such as a sky dome or a room.
// The eye should be inside them.
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

// Returns the least distance of the eye from the centre of a box at which the whole box is in view,
// with a margin of a tenth of the image. `back` is the unit vector from the centre to the eye.
float distance_in_view(const Bounds& bounds, const glm::vec3& back, float fov_y, float aspect) {
  constexpr float kFilled = 0.9f;  // of the half-width and half-height of the image
  const float up_limit = kFilled * std::tan(0.5f * fov_y), right_limit = up_limit * aspect;
  const glm::vec3 right = glm::normalize(glm::cross(Camera().up_ws, back));
  const glm::vec3 up = glm::cross(back, right);
  const glm::vec3 centre = 0.5f * (bounds.low + bounds.high);
  float distance = 0.0f;
  for (const glm::vec3& corner : corners_of(bounds)) {
    const glm::vec3 at = corner - centre;
    distance = std::max({distance, glm::dot(at, back) + std::abs(glm::dot(at, up)) / up_limit,
                         glm::dot(at, back) + std::abs(glm::dot(at, right)) / right_limit});
  }
  return distance;
}

}  // namespace

Camera framing_camera(const Scene& scene, double aspect) {
  const Bounds& core = scene.core_bounds_ws;
  const glm::vec3 centre = 0.5f * (core.low + core.high);
  const float radius = std::max(static_cast<float>(0.5 * diagonal(core)), 1e-6f);
  Camera camera;
  camera.name = "frame";
  camera.origin = scene.origin;
  camera.fov_y = glm::radians(45.0f);
  camera.target_ws = centre;
  camera.fit_planes = true;
  const std::vector<Bounds> shells = shells_around_core(scene);
  constexpr glm::vec3 kSides[] = {
      {0.6f, 0.45f, 0.85f}, {-0.85f, 0.45f, 0.6f}, {-0.6f, 0.45f, -0.85f}, {0.85f, 0.45f, -0.6f}};
  const auto eye_at = [&](const glm::vec3& side) {
    const glm::vec3 back = glm::normalize(side);
    const float distance = distance_in_view(core, back, camera.fov_y, static_cast<float>(aspect));
    return centre + std::max(distance, 0.1f * radius) * back;
  };
  camera.eye_ws = eye_at(kSides[0]);
  for (const glm::vec3& side : kSides) {
    const glm::vec3 eye = eye_at(side);
    const auto holds_eye = [&](const Bounds& shell) { return contains(shell, eye); };
    if (!std::ranges::all_of(shells, holds_eye)) continue;
    camera.eye_ws = eye;
    break;
  }
  const float distance = glm::distance(camera.eye_ws, centre);
  camera.near_plane = 0.02f * distance;
  camera.far_plane =
      distance + 4.0f * std::max(radius, static_cast<float>(diagonal(scene.bounds_ws)));
  return camera;
}

}  // namespace alcove::sample
