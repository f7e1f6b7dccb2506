#include "reference_occlusion.h"

#include <cmath>
#include <numbers>

namespace alcove::passes {
namespace {

constexpr int kSlices = 48;
constexpr int kAngles = 128;  // integration steps of a slice
constexpr double kStepPx = 0.5;

struct Point {
  glm::dvec2 pixel;
  glm::dvec3 position;
  glm::dvec3 normal;
  glm::dvec3 view;
};

// Returns the largest cosine between the view direction and the direction to a visible surface
// point in one half-slice, or -1 if none lies within the radius.
double highest_cosine(const Drawing& drawing, const Point& point, glm::dvec2 direction_px,
                      double radius) {
  double highest = -1.0;
  for (double step = 1.0;; step += kStepPx) {
    const glm::dvec2 at = point.pixel + step * direction_px;
    if (at.x < 0.5 || at.y < 0.5 || at.x > drawing.camera.width() - 0.5 ||
        at.y > drawing.camera.height() - 0.5)
      return highest;
    const auto hit = cast(drawing.scene, drawing.camera.ray(at.x, at.y));
    if (!hit) continue;
    const glm::dvec3 delta = hit->position - point.position;
    const double distance = glm::length(delta);
    if (distance <= radius) highest = std::max(highest, glm::dot(delta, point.view) / distance);
  }
}

}  // namespace

ReferenceOcclusion reference_occlusion(const Drawing& drawing, std::uint32_t x, std::uint32_t y,
                                       double radius) {
  const glm::dvec2 pixel(x + 0.5, y + 0.5);
  const auto hit = cast(drawing.scene, drawing.camera.ray(pixel.x, pixel.y));
  const Point point{pixel, hit->position, hit->normal, drawing.camera.to_eye(x, y)};
  const glm::dvec3 across =
      glm::normalize(glm::cross(point.view, glm::dvec3(std::abs(point.view.x) < 0.7, 0.6, 0.3)));
  const glm::dvec3 up = glm::cross(point.view, across);

  double open = 0.0;
  double visible = 0.0;
  glm::dvec3 bent(0.0);
  for (int slice = 0; slice < kSlices; ++slice) {
    const double phi = 2.0 * std::numbers::pi * (slice + 0.5) / kSlices;
    const glm::dvec3 direction = std::cos(phi) * across + std::sin(phi) * up;
    const double small = 1e-4 * glm::length(point.position);
    const glm::dvec2 ahead(drawing.camera.project(point.position + small * direction));
    const glm::dvec2 behind(drawing.camera.project(point.position - small * direction));
    const double horizon = highest_cosine(drawing, point, glm::normalize(ahead - behind), radius);
    for (int i = 0; i < kAngles; ++i) {
      const double theta = std::numbers::pi * (i + 0.5) / kAngles;
      const glm::dvec3 towards = std::cos(theta) * point.view + std::sin(theta) * direction;
      const double weight = std::max(glm::dot(towards, point.normal), 0.0) * std::sin(theta);
      open += weight;
      if (std::cos(theta) > horizon) {
        visible += weight;
        bent += weight * towards;
      }
    }
  }
  return {visible / open, glm::normalize(bent)};
}

}  // namespace alcove::passes
