#include "drawing.h"

#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>

namespace alcove::passes {
namespace {

glm::dmat4 in_double(const float (&matrix)[16]) {
  glm::mat4 single;
  std::memcpy(&single[0][0], matrix, sizeof(single));
  return glm::dmat4(single);
}

}  // namespace

Shape plane(const glm::dvec3& through, const glm::dvec3& normal) {
  const glm::dvec3 unit = glm::normalize(normal);
  return {[=](const Ray& ray) -> std::vector<Hit> {
            const double slope = glm::dot(ray.along, unit);
            if (slope == 0.0) return {};
            const double t = glm::dot(through - ray.from, unit) / slope;
            return {{t, ray.from + t * ray.along, unit}};
          },
          {}};
}

Shape tilted_plane(double tilt_degrees, double distance) {
  const double tilt = tilt_degrees * std::numbers::pi / 180.0;
  const double across = std::sin(tilt) / std::numbers::sqrt2;
  return plane({0.0, 0.0, -distance}, {across, across, std::cos(tilt)});
}

Shape sphere(const glm::dvec3& centre, double radius) {
  return {[=](const Ray& ray) -> std::vector<Hit> {
            const glm::dvec3 from = ray.from - centre;
            const double a = glm::dot(ray.along, ray.along);
            const double b = glm::dot(from, ray.along);
            const double discriminant = b * b - a * (glm::dot(from, from) - radius * radius);
            if (discriminant < 0.0) return {};
            std::vector<Hit> hits;
            for (const double side : {-1.0, 1.0}) {
              const double t = (-b + side * std::sqrt(discriminant)) / a;
              const glm::dvec3 position = ray.from + t * ray.along;
              hits.push_back({t, position, (position - centre) / radius});
            }
            return hits;
          },
          {}};
}

std::vector<Shape> box(const glm::dvec3& low, const glm::dvec3& high) {
  std::vector<Shape> faces;
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true}) {
      glm::dvec3 outwards(0.0);
      outwards[axis] = upper ? 1.0 : -1.0;
      faces.push_back(plane(upper ? high : low, outwards));
      faces.back().keep = [=](const glm::dvec3& p) {
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        return p[u] >= low[u] && p[u] <= high[u] && p[v] >= low[v] && p[v] <= high[v];
      };
    }
  }
  return faces;
}

TestCamera::TestCamera(const AlcoveCamera& view, std::uint32_t width, std::uint32_t height)
    : clip_from_view_(in_double(view.clip_from_view)),
      view_from_clip_(glm::inverse(clip_from_view_)),
      width_(width),
      height_(height),
      reversed_(clip_from_view_[2][2] * clip_from_view_[3][3] >
                clip_from_view_[3][2] * clip_from_view_[2][3]) {}

Ray TestCamera::ray(double x, double y) const {
  const double u = 2.0 * x / width_ - 1.0;
  const double v = 2.0 * y / height_ - 1.0;
  // The view ray goes through the point on the near plane and through a point behind it. The far
  // plane is not used, because it may be infinite.
  const glm::dvec4 near = view_from_clip_ * glm::dvec4(u, v, reversed_ ? 1.0 : 0.0, 1.0);
  const glm::dvec4 behind = view_from_clip_ * glm::dvec4(u, v, 0.5, 1.0);
  const glm::dvec3 from = glm::dvec3(near) / near.w;
  return {from, glm::dvec3(behind) / behind.w - from};
}

glm::dvec3 TestCamera::project(const glm::dvec3& position) const {
  const glm::dvec4 clip = clip_from_view_ * glm::dvec4(position, 1.0);
  return {(clip.x / clip.w + 1.0) * 0.5 * width_, (clip.y / clip.w + 1.0) * 0.5 * height_,
          clip.z / clip.w};
}

glm::dvec3 TestCamera::to_eye(std::uint32_t x, std::uint32_t y) const {
  return -glm::normalize(ray(x + 0.5, y + 0.5).along);
}

std::optional<Hit> cast(const Scene& scene, const Ray& ray) {
  std::optional<Hit> nearest;
  for (const Shape& surface : scene) {
    for (const Hit& hit : surface.meet(ray))
      if (hit.t > 0.0 && (!nearest || hit.t < nearest->t) &&
          (!surface.keep || surface.keep(hit.position)))
        nearest = hit;
  }
  if (nearest && glm::dot(nearest->normal, ray.along) > 0.0) nearest->normal = -nearest->normal;
  return nearest;
}

bool Drawing::is_sky(std::uint32_t x, std::uint32_t y) const {
  const float depth = depth_ndc.at(x, y);
  return std::isnan(depth) || depth == camera.sky();
}

namespace {

// Draws the hits that `hit_by` finds along the ray of each pixel.
template <typename HitBy>
Drawing draw_hits(const TestView& view, std::uint32_t width, std::uint32_t height,
                  const Scene& scene, const HitBy& hit_by) {
  Drawing drawing{view.view,
                  TestCamera(view.view, width, height),
                  scene,
                  {width, height, {}, 1},
                  {width, height, {}, 4}};
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const std::optional<Hit> hit = hit_by(drawing.camera.ray(x + 0.5, y + 0.5));
      const double depth = hit ? drawing.camera.project(hit->position).z : -1.0;
      const bool seen = depth > 0.0 && depth < 1.0;
      drawing.depth_ndc.texels.push_back(seen ? static_cast<float>(depth) : drawing.camera.sky());
      const glm::dvec3 normal = seen ? hit->normal : glm::dvec3(0.0, 0.0, 1.0);
      for (const double component : {normal.x, normal.y, normal.z, 0.0})
        drawing.normal_vs.texels.push_back(static_cast<float>(component));
    }
  }
  return drawing;
}

// Returns the scene with only those hits of each surface for which `keep(hit, ray)` is true.
template <typename Keep>
Scene with_hits(const Scene& scene, const Keep& keep) {
  Scene result = scene;
  for (Shape& surface : result) {
    surface.meet = [all = surface.meet, keep](const Ray& ray) {
      std::vector<Hit> hits = all(ray);
      std::erase_if(hits, [&](const Hit& hit) { return !keep(hit, ray); });
      return hits;
    };
  }
  return result;
}

}  // namespace

Drawing draw(const TestView& view, std::uint32_t width, std::uint32_t height, const Scene& scene) {
  return draw_hits(view, width, height, scene, [&](const Ray& ray) { return cast(scene, ray); });
}

Scene transform(const Scene& scene, double scale, const glm::dvec3& shift) {
  Scene result;
  for (const Shape& surface : scene) {
    Shape shape;
    shape.meet = [=](const Ray& ray) {
      std::vector<Hit> hits = surface.meet({(ray.from - shift) / scale, ray.along / scale});
      for (Hit& hit : hits) hit.position = hit.position * scale + shift;
      return hits;
    };
    if (surface.keep)
      shape.keep = [=](const glm::dvec3& p) { return surface.keep((p - shift) / scale); };
    result.push_back(std::move(shape));
  }
  return result;
}

HostImage draw_back_faces(const TestView& view, std::uint32_t width, std::uint32_t height,
                          const Scene& scene) {
  const Scene backs = with_hits(
      scene, [](const Hit& hit, const Ray& ray) { return glm::dot(hit.normal, ray.along) > 0.0; });
  return draw(view, width, height, backs).depth_ndc;
}

HostImage draw_second_layer(const TestView& view, std::uint32_t width, std::uint32_t height,
                            const Scene& scene) {
  const auto behind_first = [&](const Ray& ray) {
    const auto first = cast(scene, ray);
    const Scene behind = with_hits(scene, [&](const Hit& hit, const Ray& along) {
      return first && hit.t > 1.001 * first->t && glm::dot(hit.normal, along.along) < 0.0;
    });
    return cast(behind, ray);
  };
  return draw_hits(view, width, height, scene, behind_first).depth_ndc;
}

}  // namespace alcove::passes
