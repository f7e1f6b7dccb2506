// Draws depth buffers and normals of simple surfaces by casting rays in double precision.
// References for tests are computed from the same exact surfaces.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "views.h"

namespace alcove::passes {

// Positions and directions are in view space: right-handed, with the camera along -Z.
struct Ray {
  glm::dvec3 from;
  glm::dvec3 along;  // direction, not of unit length
};

struct Hit {
  double t = 0.0;  // position along the ray, above 0
  glm::dvec3 position{0.0};
  glm::dvec3 normal{0.0};  // unit, towards the ray's origin
};

struct Shape {
  // Returns the hits of a ray with the surface, from near to far. Normals may point to either side
  // of the surface. Only draw_back_faces() needs normals that point outwards.
  std::function<std::vector<Hit>(const Ray&)> meet;
  // Returns whether a point of the surface exists. Null: all points exist.
  std::function<bool(const glm::dvec3&)> keep;
};

Shape plane(const glm::dvec3& through, const glm::dvec3& normal);
// Returns a plane through the point `distance` in front of the eye, tilted about the image's
// diagonal.
Shape tilted_plane(double tilt_degrees, double distance);
Shape sphere(const glm::dvec3& centre, double radius);
// Returns the six faces of an axis-aligned box.
std::vector<Shape> box(const glm::dvec3& low, const glm::dvec3& high);

// A view over an image, in double precision.
class TestCamera {
 public:
  TestCamera(const AlcoveCamera& view, std::uint32_t width, std::uint32_t height);

  // Returns the ray through a point of the image, in pixels.
  Ray ray(double x, double y) const;
  // Returns the image position of a point in pixels, and its raw depth.
  glm::dvec3 project(const glm::dvec3& position) const;
  // Returns the unit direction to the eye at pixel (x, y).
  glm::dvec3 to_eye(std::uint32_t x, std::uint32_t y) const;
  // Returns the raw depth of the far plane.
  float sky() const { return reversed_ ? 0.0f : 1.0f; }

  std::uint32_t width() const { return width_; }
  std::uint32_t height() const { return height_; }

 private:
  glm::dmat4 clip_from_view_;
  glm::dmat4 view_from_clip_;
  std::uint32_t width_;
  std::uint32_t height_;
  bool reversed_;
};

using Scene = std::vector<Shape>;

// Returns the nearest hit of a ray.
std::optional<Hit> cast(const Scene& scene, const Ray& ray);

struct Drawing {
  AlcoveCamera view{};
  TestCamera camera;
  Scene scene;
  HostImage depth_ndc;
  HostImage normal_vs;  // four channels

  bool is_sky(std::uint32_t x, std::uint32_t y) const;
};

Drawing draw(const TestView& view, std::uint32_t width, std::uint32_t height, const Scene& scene);

// Returns a copy of a scene, scaled about the eye and then moved.
Scene transform(const Scene& scene, double scale, const glm::dvec3& shift = glm::dvec3(0.0));

// Returns the depth of the nearest faces that face away from the eye.
HostImage draw_back_faces(const TestView& view, std::uint32_t width, std::uint32_t height,
                          const Scene& scene);

// Returns the depth of the nearest faces that face the eye behind those of draw().
HostImage draw_second_layer(const TestView& view, std::uint32_t width, std::uint32_t height,
                            const Scene& scene);

}  // namespace alcove::passes
