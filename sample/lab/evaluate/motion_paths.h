#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "reference/truth.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "support/glm.h"
#include "support/result.h"

namespace alcove::sample {

// The camera and object paths that `alcove motion` measures.
enum class MotionKind : std::uint8_t {
  orbit,   // The camera orbits a point in the middle of the view at the median surface depth.
  dolly,   // The camera moves towards that point.
  object,  // The camera is static and an added object slides over the ground.
  cut,     // The camera is static and jumps to another place in the middle of the path.
};

inline constexpr std::array kMotionKinds{MotionKind::orbit, MotionKind::dolly, MotionKind::object,
                                         MotionKind::cut};

// Names in the order of the enumerators.
inline constexpr std::array<std::string_view, 4> kMotionKindNames{"orbit", "dolly", "object",
                                                                  "cut"};

constexpr std::string_view name_of(MotionKind kind) {
  return kMotionKindNames[static_cast<std::size_t>(kind)];
}

// The view that a path starts from, and the lengths that its steps are proportional to.
struct MotionStart {
  Camera camera;                                 // camera of the first frame
  float depth = 1;                               // median depth of the surfaces in view, > 0
  glm::vec3 ground_ws{0.0f};                     // a surface in the lower half of the view
  glm::vec3 ground_normal_ws{0.0f, 1.0f, 0.0f};  // unit, towards the eye
  float radius = 1;                              // radius of the occlusion
};
// Measures the surfaces in view. `aspect` is width over height. Error: the view shows nothing but
// sky.
[[nodiscard]] Result<MotionStart> motion_start(const RayScene& rays, const Camera& camera,
                                               float aspect, float radius);

// The camera and the moving object in each frame. Steps are proportional to the depth and to the
// height of the view, and do not depend on the size of the image in pixels. Immutable.
class MotionPath {
 public:
  // `frames`: at least 2. The first frame shows the view of `start`.
  MotionPath(MotionKind kind, const MotionStart& start, std::uint32_t frames);

  MotionKind kind() const { return kind_; }
  std::uint32_t frames() const { return frames_; }
  Camera camera(std::uint32_t frame) const;
  // Rotation and translation of the moving object; identity if the path has none.
  glm::mat4 world_from_moving(std::uint32_t frame) const;
  // The first frame after the cut, if the path has one.
  std::optional<std::uint32_t> cut() const;

  // Adds the moving object of the path, if it has one, to a scene.
  void add_to(Scene& scene) const;
  // Moves the object that add_to() added to its place in a frame.
  void pose(Scene& scene, std::uint32_t frame) const;
  // Returns whether a point lies within the occlusion radius of the moving object in this frame, or
  // did so in one of the last `frames` frames. The object may then have left a trail there.
  bool is_near_object(const glm::vec3& position_ws, std::uint32_t frame,
                      std::uint32_t frames) const;
  // Where a surface point of a frame was one frame earlier; `frame` is at least 1.
  glm::vec3 position_before(const glm::vec3& position_ws, std::uint32_t frame) const;

 private:
  MotionKind kind_;
  MotionStart start_;
  std::uint32_t frames_;
};

}  // namespace alcove::sample
