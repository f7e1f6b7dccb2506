#include "evaluate/motion_paths.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "scene/shapes.h"
#include "support/median.h"

namespace alcove::sample {
namespace {

// How far the camera and the object move per frame, in units that do not depend on the scene:
// depths, and heights. A height is the length that the image's height spans at a given depth.
const float kOrbitAngle = glm::radians(0.4f);
constexpr float kDollyStep = 0.006f;    // depths
constexpr float kObjectStep = 0.0075f;  // heights at the ground: 4 pixels at 540
const float kObjectRotation = glm::radians(1.5f);

// The moving object: half its width in heights, and its gap to the ground in occlusion radii.
constexpr float kObjectSize = 0.06f;
constexpr float kObjectGap = 0.2f;
// The camera after the cut: distance forwards as a fraction of the median depth, and rotation.
constexpr float kCutStep = 0.4f;
const float kCutAngle = glm::radians(40.0f);

struct Axes {
  glm::vec3 right;
  glm::vec3 up;
  glm::vec3 forward;
};

Axes view_axes(const Camera& camera) {
  const glm::mat4 world_from_view = camera_matrices(camera, 1, 1).world_from_view;
  return {glm::vec3(world_from_view[0]), glm::vec3(world_from_view[1]),
          -glm::vec3(world_from_view[2])};
}

// Scene units that the image's height spans at a depth.
float height_at(const Camera& camera, float depth) {
  return camera.orthographic ? camera.ortho_height : 2.0f * std::tan(0.5f * camera.fov_y) * depth;
}

Camera moved(Camera camera, const glm::vec3& by) {
  camera.eye_ws += by;
  camera.target_ws += by;
  return camera;
}

// The distance from the middle of the path, in frames.
float frames_from_middle(std::uint32_t frame, std::uint32_t frames) {
  return static_cast<float>(frame) - 0.5f * static_cast<float>(frames - 1);
}

// A block with a smaller one on it, centred on the origin, 2 `half` wide.
Mesh block_mesh(float half) {
  SceneBuilder builder;
  builder.use(builder.add_material("moving", glm::vec3(0.6f, 0.5f, 0.4f), 0.6f));
  builder.box(glm::vec3(-half), glm::vec3(half, 0.2f * half, half));
  builder.box(glm::vec3(-0.45f, 0.2f, -0.45f) * half, glm::vec3(0.45f, 1.0f, 0.45f) * half);
  return builder.finish("moving").meshes.front();
}

float object_half_width(const MotionStart& start) {
  const float depth =
      glm::dot(start.ground_ws - start.camera.eye_ws, view_axes(start.camera).forward);
  return kObjectSize * height_at(start.camera, depth);
}

bool is_surface(const GBuffer& view, std::size_t pixel) {
  return view.material.pixels[pixel] != kNoMaterial;
}

float median_depth(const GBuffer& view) {
  std::vector<float> depths;
  for (std::size_t i = 0; i < view.material.pixels.size(); ++i)
    if (is_surface(view, i)) depths.push_back(view.depth_vs.pixels[i]);
  return median(std::move(depths));
}

}  // namespace

Result<MotionStart> motion_start(const RayScene& rays, const Camera& camera, float aspect,
                                 float radius) {
  constexpr std::uint32_t kHeight = 45;
  const auto width = static_cast<std::uint32_t>(
      std::clamp(std::round(aspect * static_cast<float>(kHeight)), 1.0f, 1000.0f));
  const GBuffer view = cast_gbuffer(rays, camera, width, kHeight);
  // The pixel with a surface that is nearest to a point of the image.
  const auto nearest = [&](glm::vec2 uv) {
    std::optional<std::size_t> found;
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < view.material.pixels.size(); ++i) {
      const std::size_t row = i / width;
      const glm::vec2 here((static_cast<float>(i - row * width) + 0.5f) / static_cast<float>(width),
                           (static_cast<float>(row) + 0.5f) / static_cast<float>(kHeight));
      const float distance = glm::distance(here, uv);
      if (is_surface(view, i) && distance < least) {
        least = distance;
        found = i;
      }
    }
    return found;
  };
  const auto ground = nearest({0.5f, 0.72f});
  if (!ground) {
    return tl::unexpected<std::string>(
        "The view shows no surface that could be measured in motion: choose another with --eye and "
        "--target.");
  }
  return MotionStart{camera, median_depth(view), view.position_ws.pixels[*ground],
                     view.geometric_normal_ws.pixels[*ground], radius};
}

MotionPath::MotionPath(MotionKind kind, const MotionStart& start, std::uint32_t frames)
    : kind_(kind), start_(start), frames_(frames) {
  const Axes axes = view_axes(start.camera);
  start_.camera.target_ws = start.camera.eye_ws + axes.forward * start.depth;
}

Camera MotionPath::camera(std::uint32_t frame) const {
  const Axes axes = view_axes(start_.camera);
  const auto steps = static_cast<float>(frame);
  switch (kind_) {
    case MotionKind::orbit:
      return orbited(start_.camera, kOrbitAngle * steps);
    case MotionKind::dolly:
      return moved(start_.camera, axes.forward * (kDollyStep * start_.depth * steps));
    case MotionKind::object:
      return start_.camera;
    case MotionKind::cut:
      break;
  }
  if (frame < frames_ / 2) return start_.camera;
  Camera elsewhere = moved(start_.camera, axes.forward * (kCutStep * start_.depth));
  const glm::mat3 rotation(glm::rotate(glm::mat4(1.0f), kCutAngle, axes.up));
  elsewhere.target_ws = elsewhere.eye_ws + rotation * axes.forward;
  return elsewhere;
}

glm::mat4 MotionPath::world_from_moving(std::uint32_t frame) const {
  if (kind_ != MotionKind::object) return glm::mat4(1.0f);
  const Axes axes = view_axes(start_.camera);
  const glm::vec3& up = start_.ground_normal_ws;
  // Rightwards along the ground, or upwards if the ground faces right or left.
  const glm::vec3 sideways = axes.right - up * glm::dot(axes.right, up);
  const glm::vec3 direction = glm::length(sideways) > 0.1f ? glm::normalize(sideways) : axes.up;
  const float half = object_half_width(start_);
  const float step = kObjectStep / kObjectSize * half;
  glm::mat4 placed(glm::mat3(direction, up, glm::cross(direction, up)));
  placed[3] = glm::vec4(start_.ground_ws + up * (half + kObjectGap * start_.radius) +
                            direction * (step * frames_from_middle(frame, frames_)),
                        1.0f);
  return glm::rotate(placed, kObjectRotation * static_cast<float>(frame), glm::vec3(0, 1, 0));
}

std::optional<std::uint32_t> MotionPath::cut() const {
  return kind_ == MotionKind::cut ? std::optional(frames_ / 2) : std::nullopt;
}

void MotionPath::add_to(Scene& scene) const {
  if (kind_ != MotionKind::object) return;
  Mesh mesh = block_mesh(object_half_width(start_));
  mesh.material = static_cast<std::uint32_t>(scene.materials.size());
  mesh.moves = true;
  scene.materials.push_back({.name = mesh.name, .roughness = 0.6f});
  scene.meshes.push_back(std::move(mesh));
}

void MotionPath::pose(Scene& scene, std::uint32_t frame) const {
  if (kind_ != MotionKind::object) return;
  const glm::mat4 placed = world_from_moving(frame);
  const Mesh at_rest = block_mesh(object_half_width(start_));
  Mesh& mesh = scene.meshes.back();
  for (std::size_t i = 0; i < at_rest.positions.size(); ++i) {
    mesh.positions[i] = glm::vec3(placed * glm::vec4(at_rest.positions[i], 1.0f));
    mesh.normals[i] = glm::mat3(placed) * at_rest.normals[i];
  }
}

bool MotionPath::is_near_object(const glm::vec3& position_ws, std::uint32_t frame,
                                std::uint32_t frames) const {
  if (kind_ != MotionKind::object) return false;
  const float half = object_half_width(start_);
  for (std::uint32_t i = 0; i <= std::min(frames, frame); ++i) {
    const glm::mat4 placed = world_from_moving(frame - i);
    // There is no scale, so the transpose is the inverse.
    const glm::vec3 offset =
        glm::transpose(glm::mat3(placed)) * (position_ws - glm::vec3(placed[3]));
    const glm::vec3 beyond = glm::max(glm::abs(offset) - half, glm::vec3(0.0f));
    if (glm::dot(beyond, beyond) < start_.radius * start_.radius) return true;
  }
  return false;
}

glm::vec3 MotionPath::position_before(const glm::vec3& position_ws, std::uint32_t frame) const {
  if (kind_ != MotionKind::object) return position_ws;
  const glm::vec4 position(position_ws, 1.0f);
  const glm::vec4 at_rest = glm::inverse(world_from_moving(frame)) * position;
  const float half = 1.02f * object_half_width(start_);
  const bool on_object =
      std::abs(at_rest.x) < half && std::abs(at_rest.y) < half && std::abs(at_rest.z) < half;
  return on_object ? glm::vec3(world_from_moving(frame - 1) * at_rest) : position_ws;
}

}  // namespace alcove::sample
