#include "views.h"

#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <numbers>
#include <utility>

namespace alcove::passes {
namespace {

AlcoveCamera view_of(const glm::dmat4& clip_from_view) {
  AlcoveCamera view;
  const glm::mat4 single(clip_from_view), identity(1.0f);
  std::memcpy(view.clip_from_view, &single, sizeof(single));
  std::memcpy(view.view_from_world, &identity, sizeof(identity));
  return view;
}

// Returns a perspective projection for a right-handed view space with the camera along -Z, y down
// on the image, depth 0 at `near` and 1 at `far`, which may be infinite, or reversed.
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
