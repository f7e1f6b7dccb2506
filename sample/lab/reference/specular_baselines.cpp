#include "reference/specular_baselines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <span>

#include "reference/height_field.h"
#include "reference/ray_scene.h"
#include "reference/sampling.h"
#include "reference/visibility_polynomials.h"
#include "support/parallel.h"

namespace alcove::sample {
namespace {

constexpr std::size_t kPacket = 16;  // directions traced together
using Packet = std::array<glm::vec3, kPacket>;

// The horizons of the height field around a pixel, at evenly spaced azimuths.
class DepthHorizons {
 public:
  // `normal_vs`: unit.
  DepthHorizons(const HeightField& field, const FieldPoint& point, const glm::vec3& normal_vs)
      : point_(point) {
    // Up to rounding, the horizon of a plane is the plane itself. This slack keeps it from
    // occluding directions that are just above it.
    constexpr float kTangentSlack = 0.01f;
    for (std::size_t i = 0; i < kAzimuths; ++i) {
      const glm::vec3 side = across_view(point, static_cast<float>(i) / kPerRadian);
      const float tilt =
          std::atan2(glm::dot(normal_vs, side), std::max(glm::dot(normal_vs, point.view), 0.0f));
      const float horizon = horizon_angle(field, point, side);
      const bool open = horizon > tilt + glm::half_pi<float>() - kTangentSlack;
      cosines_[i] = open ? -2.0f : std::cos(horizon);
    }
  }

  // Whether a unit view-space direction above the surface is occluded.
  [[nodiscard]] bool block(const glm::vec3& direction_vs) const {
    const float phi =
        std::atan2(glm::dot(direction_vs, point_.up), glm::dot(direction_vs, point_.right));
    const long nearest = std::lround((phi + glm::two_pi<float>()) * kPerRadian);
    return glm::dot(direction_vs, point_.view) <
           cosines_[static_cast<std::size_t>(nearest) % kAzimuths];
  }

 private:
  static constexpr std::size_t kAzimuths = 96;
  static constexpr float kPerRadian = static_cast<float>(kAzimuths) / glm::two_pi<float>();

  FieldPoint point_;
  std::array<float, kAzimuths> cosines_{};  // directions with a smaller cosine are occluded
};

// A point, and the scene and the height field that may occlude its directions.
class Surroundings {
 public:
  Surroundings(const RayScene& rays, const glm::vec3& origin_ws, const Basis& basis,
               const glm::mat3& view_from_world, const DepthHorizons& horizons, float radius)
      : rays_(rays),
        origin_ws_(origin_ws),
        basis_(basis),
        view_from_world_(view_from_world),
        horizons_(horizons),
        radius_(radius) {}

  // Bit i is set if direction i, of up to 16 local directions, hits the scene.
  [[nodiscard]] uint32_t blocked_by_scene(std::span<const glm::vec3> directions) const {
    Packet packet;
    std::ranges::transform(directions, packet.begin(),
                           [&](const glm::vec3& d) { return basis_.to_world(d); });
    return rays_.impl().blocked(origin_ws_, std::span(packet).first(directions.size()), radius_);
  }
  [[nodiscard]] bool blocked_by_depth(const glm::vec3& direction) const {
    return horizons_.block(view_from_world_ * basis_.to_world(direction));
  }

 private:
  const RayScene& rays_;
  glm::vec3 origin_ws_;
  Basis basis_;
  glm::mat3 view_from_world_;
  const DepthHorizons& horizons_;
  float radius_;
};

struct Hidden {
  VisibilityPolynomials in_scene{}, in_depth{};
};

Hidden hidden_around(const Surroundings& around, uint32_t spp, uint64_t seed) {
  Hidden hidden;
  const float weight = 1.0f / static_cast<float>(spp);
  for (uint32_t first = 0; first < spp; first += kPacket) {
    Packet packet;
    const std::size_t count = std::min<std::size_t>(kPacket, spp - first);
    for (std::size_t i = 0; i < count; ++i) {
      packet[i] = cosine_direction(r2_point(first + static_cast<uint32_t>(i), seed));
    }
    const uint32_t blocked = around.blocked_by_scene(std::span(packet).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      const VisibilityPolynomials values = visibility_polynomials(packet[i]);
      if ((blocked >> i & 1u) != 0) add_weighted(hidden.in_scene, values, weight);
      if (around.blocked_by_depth(packet[i])) add_weighted(hidden.in_depth, values, weight);
    }
  }
  return hidden;
}

// The projection of a lobe on the polynomials, and its visible fraction in the height field.
struct LobeView {
  VisibilityPolynomials polynomials{};
  float open_in_depth = 1.0f;
};

LobeView look_along(const LobeSampler& lobe, const Surroundings& around, uint32_t spp,
                    uint64_t seed) {
  VisibilityPolynomials sum{};
  double all = 0.0, open = 0.0;
  for (uint32_t i = 0; i < spp; ++i) {
    const LobeSample light = lobe.at(r2_point(i, seed));
    if (light.weight <= 0.0f) continue;
    add_weighted(sum, visibility_polynomials(light.direction), light.weight);
    all += light.weight;
    if (!around.blocked_by_depth(light.direction)) open += light.weight;
  }
  LobeView view;
  if (all > 0.0) {
    add_weighted(view.polynomials, sum, static_cast<float>(1.0 / all));
    view.open_in_depth = static_cast<float>(open / all);
  }
  return view;
}

}  // namespace

std::vector<SpecularBaselines> specular_baselines(const RayScene& rays, const SurfacePoints& points,
                                                  const Image<float>& depth_vs,
                                                  const Camera& camera,
                                                  const std::vector<Image<float>>& roughness,
                                                  const TruthSettings& settings,
                                                  const Progress& progress) {
  const uint32_t width = depth_vs.width, height = depth_vs.height;
  const HeightField field = make_height_field(depth_vs, camera);
  const glm::mat3 view_from_world(camera_matrices(camera, width, height).view_from_world);
  const Viewer viewer = viewer_of(camera);
  const Image<float> open(width, height, 1.0f);
  std::vector<SpecularBaselines> baselines(roughness.size(), {open, open, open});
  const auto at_pixel = [&](uint32_t x, uint32_t y) {
    const std::size_t pixel = std::size_t{y} * width + x;
    const glm::vec3& normal = points.normal_ws.pixels[pixel];
    if (normal == glm::vec3(0.0f) || is_sky(field, x, y)) return;
    const glm::vec3& position = points.position_ws.pixels[pixel];
    const Basis basis = basis_of(normal);
    const DepthHorizons horizons(field, field_point(field, x, y, settings.radius),
                                 view_from_world * normal);
    const glm::vec3 origin =
        rays.impl().off_surface(position, points.geometric_normal_ws.pixels[pixel]);
    const Surroundings around(rays, origin, basis, view_from_world, horizons, settings.radius);
    const uint64_t seed = hash(settings.seed, pixel);
    const Hidden hidden = hidden_around(around, settings.spp, seed);
    const glm::vec3 view = basis.to_local(view_from(viewer, position));
    for (std::size_t i = 0; i < roughness.size(); ++i) {
      const LobeView lobe =
          look_along(LobeSampler(view, roughness[i].pixels[pixel]), around, settings.spp, seed);
      baselines[i].polynomials.pixels[pixel] = visible_share(hidden.in_scene, lobe.polynomials);
      baselines[i].depth.pixels[pixel] = lobe.open_in_depth;
      baselines[i].depth_polynomials.pixels[pixel] =
          visible_share(hidden.in_depth, lobe.polynomials);
    }
  };
  parallel_rows(
      height,
      [&](uint32_t y) {
        for (uint32_t x = 0; x < width; ++x) at_pixel(x, y);
      },
      progress);
  return baselines;
}

}  // namespace alcove::sample
