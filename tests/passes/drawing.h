// Depth buffers and normals of simple surfaces, drawn by rays in double precision: what an engine
// would hand to the passes, and the exact surfaces for references to search.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "views.h"

namespace alcove::passes {

// All in view space: right-handed, the camera along -Z.
struct Ray {
  glm::dvec3 from;
  glm::dvec3 along;  // not of unit length
};

struct Hit {
  double t = 0.0;  // along the ray, over 0
  glm::dvec3 position{0.0};
  glm::dvec3 normal{0.0};  // unit, towards the ray's origin
};

struct Surface {
  // Where the ray's line meets the surface, from near to far; the normals may face either way, but
  // outwards for draw_back_faces().
  std::function<std::vector<Hit>(const Ray&)> meet;
  // Which of its points exist; null: all.
  std::function<bool(const glm::dvec3&)> keep;
};

Surface plane(const glm::dvec3& through, const glm::dvec3& normal);
// Tilted about the image's diagonal, through the point `distance` before the eye.
Surface tilted_plane(double tilt_degrees, double distance);
Surface sphere(const glm::dvec3& centre, double radius);
// The six faces of a solid with edges along the axes.
std::vector<Surface> box(const glm::dvec3& low, const glm::dvec3& high);

// A view over an image, in double precision.
class TestCamera {
 public:
  TestCamera(const View& view, std::uint32_t width, std::uint32_t height);

  // The ray through a point of the image, in pixels.
  Ray ray(double x, double y) const;
  // Where a point falls on the image, in pixels, and its raw depth.
  glm::dvec3 project(const glm::dvec3& position) const;
  // Unit, from what pixel (x, y) sees towards the eye.
  glm::dvec3 to_eye(std::uint32_t x, std::uint32_t y) const;
  // The raw depth of the far plane.
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

using Scene = std::vector<Surface>;

// The surface that a ray meets first.
std::optional<Hit> cast(const Scene& scene, const Ray& ray);

struct Drawing {
  TestCamera camera;
  Scene scene;
  HostImage depth_ndc;
  HostImage normal_vs;  // four channels

  bool is_sky(std::uint32_t x, std::uint32_t y) const;
};

Drawing draw(const TestView& view, std::uint32_t width, std::uint32_t height, const Scene& scene);

// The same scene in other units, and elsewhere.
Scene scaled(const Scene& scene, double scale);
Scene shifted(const Scene& scene, const glm::dvec3& shift);

// The depth of the nearest faces that look away from the eye.
HostImage draw_back_faces(const TestView& view, std::uint32_t width, std::uint32_t height,
                          const Scene& scene);

// The depth of the nearest faces towards the eye behind what draw() shows.
HostImage draw_second_layer(const TestView& view, std::uint32_t width, std::uint32_t height,
                            const Scene& scene);

}  // namespace alcove::passes
