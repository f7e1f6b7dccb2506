// The scene and the camera of the host program. The test writes the same scene as a glTF file and
// names the same camera to `alcove render`.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace host {

struct Vertex {
  glm::vec3 position;  // world space
  glm::vec3 normal;    // world space, unit
};

// The nearest vector that A2B10G10R10_UNORM holds. Its length is nearly 1.
inline glm::vec3 in_ten_bits(glm::vec3 normal) {
  return glm::round((0.5f + 0.5f * normal) * 1023.0f) * (2.0f / 1023.0f) - 1.0f;
}

inline constexpr glm::vec3 kEye{3.3f, 2.2f, 3.7f};
inline constexpr glm::vec3 kTarget{0.0f, 0.45f, 0.0f};
inline constexpr float kFovYDegrees = 50.0f;
inline constexpr float kNear = 0.1f;
inline constexpr float kFar = 60.0f;
inline constexpr float kRadius = 0.5f;             // of the occlusion, in units of the scene
inline constexpr std::uint32_t kWidth = 256;       // of the picture that is compared
inline constexpr std::uint32_t kHeight = 143;      // neither a multiple of 4 nor of a workgroup
inline constexpr std::uint32_t kStillFrames = 32;  // frames of that picture

// A box that is turned about the vertical axis. Triangles are counter-clockwise seen from outside.
inline void add_box(std::vector<Vertex>& vertices, glm::vec3 centre, glm::vec3 half, float angle) {
  const float c = glm::cos(angle), s = glm::sin(angle);
  const auto turned = [&](glm::vec3 v) {
    return glm::vec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x);
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      glm::vec3 normal(0.0f), u(0.0f), v(0.0f);
      normal[axis] = side;
      u[(axis + 1) % 3] = side;
      v[(axis + 2) % 3] = 1.0f;
      constexpr std::array<glm::vec2, 6> kCorners{
          {{-1, -1}, {1, -1}, {1, 1}, {-1, -1}, {1, 1}, {-1, 1}}};
      for (const glm::vec2 corner : kCorners) {
        vertices.push_back(
            {centre + turned(half * (normal + corner.x * u + corner.y * v)), turned(normal)});
      }
    }
  }
}

inline std::vector<Vertex> make_scene() {
  std::vector<Vertex> vertices;
  add_box(vertices, {0.0f, -0.1f, 0.0f}, {4.0f, 0.1f, 4.0f}, 0.0f);
  add_box(vertices, {-0.6f, 1.0f, -1.9f}, {3.0f, 1.0f, 0.15f}, 0.2f);
  add_box(vertices, {-0.9f, 0.5f, 0.1f}, {0.4f, 0.5f, 0.3f}, 0.5f);
  add_box(vertices, {0.5f, 0.3f, 0.7f}, {0.35f, 0.3f, 0.25f}, -0.4f);
  add_box(vertices, {0.9f, 0.7f, -0.8f}, {0.2f, 0.7f, 0.2f}, 1.1f);
  return vertices;
}

}  // namespace host
