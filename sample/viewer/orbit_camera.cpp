#include "viewer/orbit_camera.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace alcove::sample {
namespace {

// Least angle in radians between the view direction and the up vector. At smaller angles the right
// direction is undefined.
constexpr float kPole = 0.02f;

glm::vec3 rotated(const glm::vec3& v, const glm::vec3& axis, float angle) {
  const float c = std::cos(angle), s = std::sin(angle);
  return v * c + glm::cross(axis, v) * s + axis * glm::dot(axis, v) * (1.0f - c);
}

}  // namespace

Camera turned(const Camera& camera, glm::vec2 angles) {
  Camera out = orbited(camera, -angles.x);
  const glm::vec3 up = glm::normalize(camera.up_ws);
  const glm::vec3 arm = out.eye_ws - out.target_ws;
  const glm::vec3 right(camera_matrices(out, 1, 1).world_from_view[0]);
  // `now` is the angle between the up vector and the arm. Dragging downwards moves the eye up.
  const float now = std::acos(std::clamp(glm::dot(glm::normalize(arm), up), -1.0f, 1.0f));
  const float then = std::clamp(now - angles.y, kPole, glm::pi<float>() - kPole);
  out.eye_ws = out.target_ws + rotated(arm, right, then - now);
  return out;
}

Camera panned(const Camera& camera, glm::vec2 share) {
  const glm::mat4 world_from_view = camera_matrices(camera, 1, 1).world_from_view;
  const float height = camera.orthographic ? camera.ortho_height
                                           : 2.0f * std::tan(0.5f * camera.fov_y) *
                                                 glm::distance(camera.eye_ws, camera.target_ws);
  const glm::vec3 move =
      height * (share.y * glm::vec3(world_from_view[1]) - share.x * glm::vec3(world_from_view[0]));
  Camera out = camera;
  out.eye_ws += move;
  out.target_ws += move;
  return out;
}

Camera dollied(const Camera& camera, float factor) {
  Camera out = camera;
  if (camera.orthographic) {
    out.ortho_height *= factor;
    return out;
  }
  const glm::vec3 arm = camera.eye_ws - camera.target_ws;
  const float least = 2.0f * camera.near_plane;
  const float distance = glm::length(arm);
  // If the eye is already nearer than the least distance, it is not moved away.
  const float moved = std::max(distance * factor, std::min(least, distance));
  out.eye_ws = camera.target_ws + arm * (moved / distance);
  return out;
}

}  // namespace alcove::sample
