#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"
#include "support/result.h"

namespace alcove::sample {

// A point of an analytic scene and its visibility in closed form.
struct ReferencePoint {
  glm::vec3 position_ws;
  glm::vec3 normal_ws;  // unit
  double visibility;    // cosine-weighted, 0..1
};

// A scene whose visibility is known in closed form. Its geometry is finite, so that the closed
// forms hold only if the radius of the occlusion is at least `closed_form_radius` and no ray
// reaches beyond the edges of the geometry.
struct AnalyticScene {
  Scene scene;
  double closed_form_radius;  // scene units
  std::vector<ReferencePoint> points;
};

// Returns the scene of a name: `plane:DEG` (DEG is the tilt from facing the camera, 0..89, default
// 0), `groove:DEG` (DEG is the opening angle between the walls, 10..170, default 90), `corner`,
// `sphere`, `pit` or `step`. Lengths are metres. Unknown names and angles out of range are errors
// that list the valid ones.
[[nodiscard]] Result<AnalyticScene> analytic_scene(const std::string& name);

// Returns whether `name` begins like a name of analytic_scene(). Its angle may be out of range.
[[nodiscard]] bool is_analytic_name(const std::string& name);

// Closed forms of the cosine-weighted visibility of a point in simple scenes. Lengths may have any
// unit.

// Returns the visibility of a point under a sphere: 1 - cosine (radius / distance)^2. `distance` is
// that of the sphere's centre, and `cosine` is the cosine of the angle between the normal and the
// direction to the centre. The whole sphere must be above the horizon (cosine >= radius /
// distance).
[[nodiscard]] double visibility_under_sphere(double radius, double distance, double cosine);
// Returns the visibility of any point on a wall of a V-shaped groove with infinite walls: (1 -
// cos(angle)) / 2. `opening_angle` is the angle between the walls in radians.
[[nodiscard]] double visibility_in_groove(double opening_angle);
// Returns the visibility of a point on a floor at distance d from an infinitely long wall of height
// h: (1 + d / sqrt(d^2 + h^2)) / 2.
[[nodiscard]] double visibility_beside_wall(double distance, double height);
// Returns the visibility of a point on a floor at distances a and b from two infinitely long walls
// of height h, which meet at a right angle.
[[nodiscard]] double visibility_in_corner(double a, double b, double height);
// The visibility of the centre of the floor of a cylindrical pit: r^2 / (r^2 + depth^2).
[[nodiscard]] double visibility_in_pit(double radius, double depth);

}  // namespace alcove::sample
