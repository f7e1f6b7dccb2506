#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "evaluate/motion_kind.h"
#include "reference/truth.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "support/glm.h"

namespace alcove::sample {

// What the length of a path's steps is taken from.
struct MotionStart {
  Camera camera;              // of the first frame
  float depth = 1;            // along the view axis, median of the surfaces in view, > 0
  glm::vec3 ground_ws{0.0f};  // a surface in the lower half of the view
  glm::vec3 ground_normal_ws{0.0f, 1.0f, 0.0f};  // unit, towards the eye
  float radius = 1;                              // of the occlusion
};
// Looks where the surfaces of a view are. `aspect` is width over height. Error: the view is of
// nothing but sky.
[[nodiscard]] tl::expected<MotionStart, std::string> motion_start(const RayScene& rays,
                                                                  const Camera& camera,
                                                                  float aspect, float radius);

// Where everything is in each frame. A pure function of the frame: steps are parts of the depth and
// of the image's height, whatever its size in pixels. Immutable.
class MotionPath {
 public:
  // `frames` of at least 2 from the start's view on.
  MotionPath(MotionKind kind, const MotionStart& start, std::uint32_t frames);

  MotionKind kind() const { return kind_; }
  std::uint32_t frames() const { return frames_; }
  Camera camera(std::uint32_t frame) const;
  // Of the mesh that moves, if there is one: rotation and translation.
  glm::mat4 world_from_moving(std::uint32_t frame) const;
  // The first frame that has nothing to do with the one before.
  std::optional<std::uint32_t> cut() const;

  // Puts what the path needs into a scene.
  void add_to(Scene& scene) const;
  // The scene of add_to() with what moves put where it is in a frame.
  void pose(Scene& scene, std::uint32_t frame) const;
  // Whether what moves is within the occlusion's radius of a point in a frame, or was in one of as
  // many before it as `frames` says: where it is seen to move, and might leave a trail.
  bool passes_by(const glm::vec3& position_ws, std::uint32_t frame, std::uint32_t frames) const;
  // Where a point on a surface of a frame, which counts from 1, was one frame earlier.
  glm::vec3 position_before(const glm::vec3& position_ws, std::uint32_t frame) const;

 private:
  MotionKind kind_;
  MotionStart start_;
  std::uint32_t frames_;
};

}  // namespace alcove::sample
