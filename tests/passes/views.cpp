#include "views.h"

#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <numbers>
#include <utility>

namespace alcove::passes {
namespace {

View view_of(const glm::dmat4& clip_from_view) {
  View view;
  const glm::mat4 single(clip_from_view);
  std::memcpy(view.clip_from_view.data(), &single, sizeof(single));
  return view;
}

// Returns a perspective projection for a right-handed view space with the camera along -Z, y down
// on the image, depth `near_depth` at `near` and `far_depth` at `far`, which may be infinite.
glm::dmat4 perspective(double scale_x, double scale_y, double near, double far, bool reversed) {
  glm::dmat4 m(0.0);
  m[0][0] = scale_x;
  m[1][1] = -scale_y;
  m[2][3] = -1.0;
  const double depth_near = reversed ? 1.0 : 0.0;
  const double depth_far = reversed ? 0.0 : 1.0;
  // depth = (a z + b) / -z with z = -near, -far.
  const double a =
      std::isinf(far) ? -depth_far : -(depth_far * far - depth_near * near) / (far - near);
  m[2][2] = a;
  m[3][2] = near * (depth_near + a);
  return m;
}

glm::dmat4 orthographic(double half_width, double half_height, double near, double far) {
  glm::dmat4 m(1.0);
  m[0][0] = 1.0 / half_width;
  m[1][1] = -1.0 / half_height;
  m[2][2] = -1.0 / (far - near);
  m[3][2] = -near / (far - near);
  return m;
}

}  // namespace

TestView perspective_view(std::string name, double scale_x, double scale_y, double near, double far,
                          bool reversed) {
  return {std::move(name), view_of(perspective(scale_x, scale_y, near, far, reversed))};
}

TestView orthographic_view(std::string name, double half_width, double half_height, double near,
                           double far) {
  return {std::move(name), view_of(orthographic(half_width, half_height, near, far)), true};
}

std::vector<TestView> test_views() {
  const double infinite = std::numeric_limits<double>::infinity();
  glm::dmat4 off_centre = perspective(1.2, 1.8, 0.1, 100.0, false);
  off_centre[2][0] = 0.3;
  off_centre[2][1] = -0.2;
  glm::dmat4 flipped = perspective(1.2, 1.8, 0.1, 100.0, true);
  flipped[1][1] = -flipped[1][1];
  return {{"finite", view_of(perspective(1.2, 1.8, 0.1, 100.0, false))},
          {"infinite", view_of(perspective(1.2, 1.8, 0.1, infinite, false))},
          {"reversed infinite", view_of(perspective(1.2, 1.8, 0.1, infinite, true))},
          {"off-centre", view_of(off_centre)},
          {"flipped and reversed", view_of(flipped)},
          {"orthographic", view_of(orthographic(3.0, 2.0, 0.1, 20.0)), true}};
}

PlaneScene plane_scene(const TestView& view, std::uint32_t width, std::uint32_t height,
                       float tilt_degrees) {
  glm::mat4 single;
  std::memcpy(&single[0][0], view.view.clip_from_view.data(), sizeof(single));
  const glm::dmat4 clip_from_view(single);
  const glm::dmat4 view_from_clip = glm::inverse(clip_from_view);
  const double tilt = tilt_degrees * std::numbers::pi / 180.0;
  const double across = std::sin(tilt) * std::numbers::sqrt2 / 2.0;
  const glm::dvec3 normal(across, across, std::cos(tilt));
  const glm::dvec3 through(0.0, 0.0, -4.0);

  PlaneScene scene{{width, height, {}, 1}, {width, height, {}, 4}};
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const double u = 2.0 * (x + 0.5) / width - 1.0;
      const double v = 2.0 * (y + 0.5) / height - 1.0;
      const glm::dvec4 a = view_from_clip * glm::dvec4(u, v, 0.25, 1.0);
      const glm::dvec4 b = view_from_clip * glm::dvec4(u, v, 0.75, 1.0);
      const glm::dvec3 from = glm::dvec3(a) / a.w;
      const glm::dvec3 along = glm::dvec3(b) / b.w - from;
      const double t = glm::dot(through - from, normal) / glm::dot(along, normal);
      const glm::dvec4 clip = clip_from_view * glm::dvec4(from + t * along, 1.0);
      const double depth = clip.z / clip.w;
      const bool seen = clip.w > 0.0 && depth > 0.0 && depth < 1.0;
      const bool reversed =
          clip_from_view[2][2] * clip_from_view[3][3] > clip_from_view[3][2] * clip_from_view[2][3];
      scene.depth_ndc.texels.push_back(seen ? static_cast<float>(depth) : (reversed ? 0.0f : 1.0f));
      for (const double component : {normal.x, normal.y, normal.z, 0.0})
        scene.normal_vs.texels.push_back(static_cast<float>(component));
    }
  }
  return scene;
}

TestView columns_of(TestView view, std::uint32_t width, std::uint32_t first, std::uint32_t count) {
  auto& m = view.view.clip_from_view;
  const float scale = static_cast<float>(width) / static_cast<float>(count);
  const float shift =
      (static_cast<float>(width) - 2.0f * static_cast<float>(first)) / static_cast<float>(count) -
      1.0f;
  for (std::size_t column = 0; column < 4; ++column)
    m[4 * column] = m[4 * column] * scale + m[4 * column + 3] * shift;
  return view;
}

}  // namespace alcove::passes
