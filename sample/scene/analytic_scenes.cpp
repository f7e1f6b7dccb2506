#include "scene/analytic_scenes.h"

#include <charconv>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scene/shapes.h"

namespace alcove::sample {
namespace {

constexpr double kPi = glm::pi<double>();
constexpr float kFar = 50.0f;  // how far a surface that stands for an endless one reaches

// Closed forms of the cosine-weighted visibility of a point. Lengths may have any unit.

// The visibility of a point under a sphere whose centre is at `distance`, in a direction with this
// cosine to the normal. The whole sphere must be above the horizon (cosine >= radius / distance).
double visibility_under_sphere(double radius, double distance, double cosine) {
  const double sine = radius / distance;
  return 1.0 - cosine * sine * sine;
}

// The visibility of any point on a wall of a V-shaped groove with infinite walls. The angle is in
// radians.
double visibility_in_groove(double opening_angle) { return 0.5 * (1.0 - std::cos(opening_angle)); }

// The visibility of a point on a floor beside an infinitely long wall.
double visibility_beside_wall(double distance, double height) {
  return 0.5 * (1.0 + distance / std::hypot(distance, height));
}

// The visibility of a point on a floor at distances a and b from two infinitely long walls of this
// height, which meet at a right angle. Each wall occludes the azimuths from its open end to the
// corner with the other wall. In the direction of an azimuth, a wall with the elevation e occludes
// the fraction sin^2 e of the cosine-weighted directions. At the azimuth t from the perpendicular
// of the wall at distance a, tan e = h cos t / a. The occluded part is therefore the mean over t of
// h^2 cos^2 t / (h^2 cos^2 t + a^2), which has a closed antiderivative.
double visibility_in_corner(double a, double b, double height) {
  const auto blocked = [&](double distance, double azimuth) {
    const double root = std::hypot(distance, height);
    // The integral of 1 - d^2 / (d^2 + h^2 cos^2 t) from 0 to the azimuth.
    return azimuth - distance / root * std::atan(distance * std::tan(azimuth) / root);
  };
  // Each wall extends from its open end, at an azimuth of 90 degrees, to the corner.
  const auto wall = [&](double distance, double other) {
    const double to_corner = std::atan2(other, distance);
    const double open_end = 0.5 * kPi * (1.0 - distance / std::hypot(distance, height));
    return blocked(distance, to_corner) + open_end;
  };
  return 1.0 - (wall(a, b) + wall(b, a)) / (2.0 * kPi);
}

// Of the centre of the floor of a cylindrical pit.
double visibility_in_pit(double radius, double depth) {
  return radius * radius / (radius * radius + depth * depth);
}

struct Name {
  std::string kind;
  std::string number;
};

Name split(const std::string& name) {
  const size_t colon = name.find(':');
  if (colon == std::string::npos) return {name, ""};
  return {name.substr(0, colon), name.substr(colon + 1)};
}

Camera camera(glm::vec3 eye, glm::vec3 target, glm::vec3 up = {0, 1, 0}) {
  Camera out = scene_camera("front", eye, target, 50.0f, 50.0f);
  out.up_ws = up;
  return out;
}

SceneBuilder grey_builder() {
  SceneBuilder b;
  b.use(b.add_material("grey", glm::vec3(0.5f), 0.5f));
  return b;
}

AnalyticScene finished(SceneBuilder& b, const std::string& name, const Camera& view, float radius,
                       double closed_form_radius) {
  AnalyticScene out{b.finish(name), closed_form_radius, {}};
  out.scene.cameras = {view};
  out.scene.suggested_radius = radius;
  return out;
}

// Returns a plane that is seen from +z. Its normal is tilted by `tilt` from the view direction
// towards +y.
AnalyticScene plane(float tilt) {
  SceneBuilder b = grey_builder();
  const glm::vec3 normal(0, std::sin(tilt), std::cos(tilt));
  const glm::vec3 across(1, 0, 0), along = glm::cross(normal, across);
  const auto at = [&](float u, float v) { return kFar * (u * across + v * along); };
  b.quad(at(-1, -1), at(1, -1), at(1, 1), at(-1, 1));
  AnalyticScene out = finished(b, "plane", camera({0, 0, 3}, {0, 0, 0}), 0.5f, 50.0);
  for (const float x : {-1.0f, 0.0f, 0.7f}) out.points.push_back({across * x, normal, 1.0});
  return out;
}

// Returns a groove that is open upwards: two walls that meet along the z axis.
AnalyticScene groove(float opening) {
  SceneBuilder b = grey_builder();
  const glm::vec3 right(std::sin(0.5f * opening), std::cos(0.5f * opening), 0);
  const glm::vec3 left(-right.x, right.y, 0);
  const glm::vec3 z(0, 0, kFar), foot(0.0f);
  // The walls are so long, compared with the distance of the reference points, that their ends do
  // not matter.
  b.quad(foot + z, kFar * right + z, kFar * right - z, foot - z);
  b.quad(kFar * left + z, foot + z, foot - z, kFar * left - z);
  AnalyticScene out = finished(b, "groove", camera({0, 3, 0.8f}, {0, 0, 0}, {0, 0, -1}), 1.0f, 1e4);
  const glm::vec3 normal(-right.y, right.x, 0);
  for (const float d : {0.1f, 0.25f, 0.5f})
    out.points.push_back({d * right, normal, visibility_in_groove(opening)});
  return out;
}

// Returns a floor and two walls of height 2 that meet at the origin.
AnalyticScene corner() {
  SceneBuilder b = grey_builder();
  constexpr float kHeight = 2.0f;
  const glm::vec3 o(0.0f), x(kFar, 0, 0), y(0, kHeight, 0), z(0, 0, kFar);
  b.quad(o, z, x + z, x);
  b.quad(o, y, y + z, z);
  b.quad(o, x, x + y, y);
  AnalyticScene out =
      finished(b, "corner", camera({2.2f, 1.9f, 2.6f}, {0.4f, 0.4f, 0.4f}), 0.75f, 1e4);
  for (const glm::vec2 at : {glm::vec2(0.2f, 0.3f), glm::vec2(0.5f, 0.5f), glm::vec2(1.0f, 0.1f)})
    out.points.push_back({{at.x, 0, at.y}, {0, 1, 0}, visibility_in_corner(at.x, at.y, kHeight)});
  return out;
}

// Returns a unit sphere that touches a floor.
AnalyticScene sphere() {
  SceneBuilder b = grey_builder();
  b.quad({-kFar, 0, kFar}, {kFar, 0, kFar}, {kFar, 0, -kFar}, {-kFar, 0, -kFar});
  b.sphere({0, 1, 0}, 1.0f, 96, 192);
  AnalyticScene out = finished(b, "sphere", camera({0, 2.4f, 4.2f}, {0, 0.6f, 0}), 4.0f, 20.0);
  for (const float d : {0.25f, 0.5f, 1.0f, 1.5f, 3.0f}) {
    const double distance = std::sqrt(1.0 + d * d);
    out.points.push_back(
        {{d, 0, 0}, {0, 1, 0}, visibility_under_sphere(1.0, distance, 1.0 / distance)});
  }
  return out;
}

// Returns a round hole of radius 1 and depth 1 in a floor; its bottom is at y = -1.
AnalyticScene pit() {
  SceneBuilder b = grey_builder();
  constexpr uint32_t kSides = 256;
  const auto rim = [&](uint32_t i, float radius, float y) {
    const float a = glm::two_pi<float>() * static_cast<float>(i % kSides) / kSides;
    return glm::vec3(radius * std::cos(a), y, -radius * std::sin(a));
  };
  for (uint32_t i = 0; i < kSides; ++i) {
    b.triangle({0, -1, 0}, rim(i, 1, -1), rim(i + 1, 1, -1));
    b.quad(rim(i + 1, 1, -1), rim(i, 1, -1), rim(i, 1, 0), rim(i + 1, 1, 0));
    b.quad(rim(i, 1, 0), rim(i, kFar, 0), rim(i + 1, kFar, 0), rim(i + 1, 1, 0));
  }
  AnalyticScene out =
      finished(b, "pit", camera({0, 3.4f, 0.6f}, {0, -0.5f, 0}, {0, 0, -1}), 2.0f, 20.0);
  out.points.push_back({{0, -1, 0}, {0, 1, 0}, visibility_in_pit(1.0, 1.0)});
  return out;
}

// Returns a floor and, 0.5 above it, a second floor that begins at x = 0.
AnalyticScene step() {
  SceneBuilder b = grey_builder();
  constexpr float kHeight = 0.5f;
  b.quad({-kFar, 0, kFar}, {0, 0, kFar}, {0, 0, -kFar}, {-kFar, 0, -kFar});
  b.quad({0, 0, -kFar}, {0, 0, kFar}, {0, kHeight, kFar}, {0, kHeight, -kFar});
  b.quad({0, kHeight, kFar}, {kFar, kHeight, kFar}, {kFar, kHeight, -kFar}, {0, kHeight, -kFar});
  AnalyticScene out = finished(b, "step", camera({-2.2f, 2.0f, 1.6f}, {-0.2f, 0.2f, 0}), 1.0f, 1e4);
  for (const float d : {0.1f, 0.3f, 0.8f})
    out.points.push_back({{-d, 0, 0}, {0, 1, 0}, visibility_beside_wall(d, kHeight)});
  out.points.push_back({{0.4f, kHeight, 0}, {0, 1, 0}, 1.0});
  return out;
}

Result<float> read_angle(const std::string& name, const std::string& number, float low, float high,
                         float otherwise) {
  float degrees = otherwise;
  if (!number.empty() || name.back() == ':') {
    const char* end = number.data() + number.size();
    const auto [stop, error] = std::from_chars(number.data(), end, degrees);
    if (error != std::errc{} || stop != end || !(degrees >= low && degrees <= high)) {
      return Failure("scene " + name + ": the angle must be a number of degrees from " +
                     std::to_string(static_cast<int>(low)) + " to " +
                     std::to_string(static_cast<int>(high)));
    }
  }
  return glm::radians(degrees);
}

}  // namespace

bool is_analytic_name(const std::string& name) {
  const std::string kind = split(name).kind;
  for (const char* known : {"plane", "groove", "corner", "sphere", "pit", "step"})
    if (kind == known) return true;
  return false;
}

Result<AnalyticScene> analytic_scene(const std::string& name) {
  const auto [kind, number] = split(name);
  if (kind == "plane") return read_angle(name, number, 0.0f, 89.0f, 0.0f).map(plane);
  if (kind == "groove") return read_angle(name, number, 10.0f, 170.0f, 90.0f).map(groove);
  if (name.find(':') != std::string::npos)
    return Failure("scene " + name + ": " + kind + " takes no angle");
  if (kind == "corner") return corner();
  if (kind == "sphere") return sphere();
  if (kind == "pit") return pit();
  if (kind == "step") return step();
  return Failure("there is no scene " + name + "; try " + kAnalyticExamples);
}

}  // namespace alcove::sample
