// Scenes for ambient occlusion in view space, about 4 units in front of the eye.
#pragma once

#include <cmath>
#include <string>

#include "drawing.h"

namespace alcove::passes {

// Returns two walls that meet in a line along y at x = `aside`, at the distance `bottom` from the
// eye. Each wall is at `half_angle` radians from the view axis.
inline Scene groove(double half_angle, double bottom = 4.5, double aside = 0.0) {
  const glm::dvec3 through(aside, 0.0, -bottom);
  Shape left = plane(through, {std::cos(half_angle), 0.0, std::sin(half_angle)});
  left.keep = [=](const glm::dvec3& p) { return p.x < aside; };
  Shape right = plane(through, {-std::cos(half_angle), 0.0, std::sin(half_angle)});
  right.keep = [=](const glm::dvec3& p) { return p.x >= aside; };
  return {left, right};
}

// Returns a floor that faces the eye at the distance `floor`, and a platform that is nearer by
// `height` where x > `edge`.
inline Scene step(double edge, double height, double floor = 4.0) {
  Shape platform = plane({0.0, 0.0, -floor + height}, {0.0, 0.0, 1.0});
  platform.keep = [=](const glm::dvec3& p) { return p.x > edge; };
  Shape wall = plane({edge, 0.0, 0.0}, {1.0, 0.0, 0.0});
  wall.keep = [=](const glm::dvec3& p) { return p.z > -floor && p.z < -floor + height; };
  return {plane({0.0, 0.0, -floor}, {0.0, 0.0, 1.0}), platform, wall};
}

// Returns a sphere that lies on a tilted floor.
inline Scene ball_on_floor() {
  const glm::dvec3 normal = glm::normalize(glm::dvec3(0.1, 0.5, 1.0));
  const glm::dvec3 through(0.0, 0.0, -4.2);
  const double radius = 0.7;
  return {plane(through, normal), sphere(through + radius * normal, radius)};
}

struct NamedScene {
  std::string name;
  Scene scene;
};

inline std::vector<NamedScene> gtao_scenes() {
  return {{"groove", groove(0.8)}, {"step", step(0.31, 0.6)}, {"ball", ball_on_floor()}};
}

}  // namespace alcove::passes
