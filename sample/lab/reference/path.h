// The loops that the ray-traced truths share: over the surface points, and along a path.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "reference/sampling.h"
#include "reference/truth.h"
#include "scene/ray_scene.h"
#include "support/parallel.h"

namespace alcove::sample {

// Runs `shade(pixel, seed)` on all threads for every pixel that has a surface.
template <class Shade>
void for_each_surface(const SurfacePoints& points, uint32_t seed, const Progress& progress,
                      const Shade& shade) {
  const Image<glm::vec3>& normals = points.normal_ws;
  parallel_rows(
      normals.height,
      [&](uint32_t y) {
        for (size_t pixel = size_t{y} * normals.width; pixel < size_t{y + 1} * normals.width;
             ++pixel)
          if (normals.pixels[pixel] != glm::vec3(0.0f)) shade(pixel, hash(seed, pixel));
      },
      progress);
}

// Returns the origin of the rays that leave the surface point of a pixel.
inline glm::vec3 ray_start(const RayScene& scene, const SurfacePoints& points, size_t pixel) {
  return scene.off_surface(points.position_ws.pixels[pixel],
                           points.geometric_normal_ws.pixels[pixel]);
}

// A direction of a path, and the weight of its light: BRDF times cosine over density.
struct Scattered {
  glm::vec3 direction_ws;
  glm::vec3 weight;
};

// Follows a path until it hits nothing within the radius. Returns its last direction and the
// product of the weights of its bounces, or nothing if Russian roulette or `scatter` ends it.
// `scatter(hit, direction_ws, bits)` samples the next direction with 64 random bits.
template <class Scatter>
std::optional<Scattered> follow_path(const RayScene& scene, glm::vec3 origin, glm::vec3 direction,
                                     float radius, uint64_t seed, const Scatter& scatter) {
  constexpr uint32_t kLongest = 256;  // the weight is below 1e-8 even at an albedo of 0.93
  constexpr uint32_t kSure = 3;       // bounces without Russian roulette, at the start of a path
  glm::vec3 weight(1.0f);
  for (uint32_t bounce = 0; bounce < kLongest; ++bounce) {
    const std::optional<Hit> hit = scene.nearest(origin, direction, radius);
    if (!hit) return Scattered{direction, weight};
    const uint64_t bits = hash(seed, bounce);
    const std::optional<Scattered> next = scatter(*hit, direction, bits);
    if (!next) return std::nullopt;
    weight *= next->weight;
    const float survival = std::min(std::max({weight.x, weight.y, weight.z}), 0.98f);
    if (!(survival > 0.0f)) return std::nullopt;
    if (bounce >= kSure) {
      if (unit_float(hash(bits, 7)) >= survival) return std::nullopt;
      weight /= survival;
    }
    origin = scene.off_surface(origin + direction * hit->distance, hit->geometric_normal_ws);
    direction = next->direction_ws;
  }
  return std::nullopt;
}

}  // namespace alcove::sample
