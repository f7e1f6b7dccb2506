#pragma once

#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "scene/scene.h"

namespace alcove::sample {

// A point of an analytic scene and its visibility in closed form.
struct ReferencePoint {
  glm::vec3 position_ws;
  glm::vec3 normal_ws;  // unit
  double visibility;    // cosine-weighted, 0..1
};

// A scene whose occlusion is known. The closed forms hold for rays of at least
// `closed_form_radius`, short of the edges of the geometry, which is finite.
struct AnalyticScene {
  Scene scene;
  double closed_form_radius;  // scene units
  std::vector<ReferencePoint> points;
};

// By name: `plane:DEG` (tilt from facing the camera, 0..89; 0 without a number), `groove:DEG`
// (opening angle between its walls, 10..170; 90), `corner`, `sphere`, `pit`, `step`. Metres.
// Errors: an unknown name or an angle out of range, with what is allowed.
[[nodiscard]] tl::expected<AnalyticScene, std::string> analytic_scene(const std::string& name);

// Whether `name` is meant for analytic_scene, right or wrong in its angle.
[[nodiscard]] bool is_analytic_name(const std::string& name);

// The closed forms, each at a point with its normal up, the share of the cosine-weighted hemisphere
// that the shape leaves open.

// Sphere of `radius` whose centre stands at distance d in a direction `cosine` from the normal, all
// of it above the horizon (cosine >= radius / d): 1 - cosine (radius / d)^2.
[[nodiscard]] double visibility_under_sphere(double radius, double distance, double cosine);
// V-groove of infinite length, from anywhere on a wall, walls endless: the other wall rises
// from the edge to pi minus the opening angle (radians), which leaves (1 - cos(angle)) / 2.
[[nodiscard]] double visibility_in_groove(double opening_angle);
// Floor at distance d from an endless wall of height h: (1 + d / sqrt(d^2 + h^2)) / 2.
[[nodiscard]] double visibility_beside_wall(double distance, double height);
// Floor of a corner of two endless walls of height h at right angles, at distances a and b.
[[nodiscard]] double visibility_in_corner(double a, double b, double height);
// Centre of a cylindrical pit's floor: r^2 / (r^2 + depth^2).
[[nodiscard]] double visibility_in_pit(double radius, double depth);

}  // namespace alcove::sample
