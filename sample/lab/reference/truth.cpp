#include "reference/truth.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>

#include "reference/path.h"

namespace alcove::sample {
namespace {

constexpr uint32_t kPacket = 16;  // rays traced together

// Stores a hit in one pixel of the g-buffer.
void store_hit(const Scene& scene, const Hit& hit, const Ray& ray, const glm::vec3& forward,
               size_t pixel, GBuffer& out) {
  const glm::vec3 offset = ray.direction_ws * hit.distance;
  const Material& material = scene.materials[hit.material];
  const glm::vec4 metal_roughness =
      sample_texture(scene, material.metal_roughness_texture, hit.uvs);
  out.depth_vs.pixels[pixel] = glm::dot(offset, forward);
  out.position_ws.pixels[pixel] = ray.origin_ws + offset;
  out.geometric_normal_ws.pixels[pixel] = hit.geometric_normal_ws;
  out.shading_normal_ws.pixels[pixel] = hit.shading_normal_ws;
  out.albedo.pixels[pixel] = albedo_at(scene, hit);
  out.roughness.pixels[pixel] = material.roughness * metal_roughness.g;
  out.metallic.pixels[pixel] = material.metallic * metal_roughness.b;
  out.material.pixels[pixel] = hit.material;
}

// The weighted rays of a point.
struct Rays {
  double open = 0.0, all = 0.0;  // sums of weights
  glm::vec3 open_direction{0.0f};
};

// Traces the rays that `sample` chooses by a point of the unit square, unless their weight is 0.
template <class Sample>
Rays trace_rays(const RayScene& scene, const glm::vec3& origin, const Basis& basis,
                const Sample& sample, const TruthSettings& settings, uint64_t seed) {
  Rays rays;
  std::array<glm::vec3, kPacket> directions;
  std::array<float, kPacket> weights{};
  for (uint32_t first = 0; first < settings.spp; first += kPacket) {
    uint32_t count = 0;
    for (uint32_t i = first; i < std::min(first + kPacket, settings.spp); ++i) {
      const LobeSample ray = sample(r2_point(i, seed));
      if (ray.weight <= 0.0f) continue;
      weights[count] = ray.weight;
      directions[count++] = basis.to_world(ray.direction);
    }
    if (count == 0) continue;
    const uint32_t blocked =
        scene.blocked(origin, std::span(directions).first(count), settings.radius);
    for (uint32_t i = 0; i < count; ++i) {
      rays.all += weights[i];
      if (blocked >> i & 1u) continue;
      rays.open += weights[i];
      rays.open_direction += directions[i];
    }
  }
  return rays;
}

}  // namespace

GBuffer cast_gbuffer(const RayScene& scene, const Camera& camera, uint32_t width, uint32_t height) {
  const CameraMatrices matrices = camera_matrices(camera, width, height);
  const glm::vec3 forward = -glm::vec3(matrices.world_from_view[2]);
  const glm::vec3 zero(0.0f);
  GBuffer out{{width, height, std::numeric_limits<float>::infinity()},
              {width, height, zero},
              {width, height, zero},
              {width, height, zero},
              {width, height, zero},
              {width, height, 1.0f},
              {width, height, 0.0f},
              {width, height, kNoMaterial}};
  parallel_rows(height, [&](uint32_t y) {
    for (uint32_t x = 0; x < width; ++x) {
      const glm::vec2 centre(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      Ray ray = camera_ray(matrices, camera.orthographic, centre, width, height);
      // Only surfaces between the near and the far plane are rendered.
      const float cosine = glm::dot(ray.direction_ws, forward);
      ray.origin_ws += ray.direction_ws * (camera.near_plane / cosine);
      const float far = (camera.far_plane - camera.near_plane) / cosine;
      const auto hit = scene.nearest(ray.origin_ws, ray.direction_ws, far);
      if (!hit) continue;
      const size_t pixel = size_t{y} * width + x;
      store_hit(scene.scene(), *hit, ray, forward, pixel, out);
      out.depth_vs.pixels[pixel] += camera.near_plane;
    }
  });
  return out;
}

OcclusionTruth occlusion_truth(const RayScene& scene, const SurfacePoints& points,
                               const TruthSettings& settings, const Progress& progress) {
  const uint32_t width = points.normal_ws.width, height = points.normal_ws.height;
  OcclusionTruth out{{width, height, 1.0f}, {width, height}};
  for_each_surface(points, settings.seed, progress, [&](size_t pixel, uint64_t seed) {
    const glm::vec3& normal = points.normal_ws.pixels[pixel];
    const auto sample = [](const glm::vec2& u) { return LobeSample{cosine_direction(u), 1.0f, 0}; };
    const Rays rays = trace_rays(scene, ray_start(scene, points, pixel), make_basis(normal), sample,
                                 settings, seed);
    const float length = glm::length(rays.open_direction);
    out.visibility.pixels[pixel] = static_cast<float>(rays.open) / static_cast<float>(settings.spp);
    out.bent_normal_ws.pixels[pixel] = length > 1e-6f ? rays.open_direction / length : normal;
  });
  return out;
}

Viewer make_viewer(const Camera& camera) {
  return {camera.orthographic, camera.eye_ws, glm::normalize(camera.eye_ws - camera.target_ws)};
}

glm::vec3 view_from(const Viewer& viewer, const glm::vec3& position_ws) {
  // In double, because the square of a tiny distance underflows in float.
  const glm::dvec3 to_eye = glm::dvec3(viewer.eye_ws) - glm::dvec3(position_ws);
  const double length = glm::length(to_eye);
  return viewer.orthographic || !(length > 0.0) ? viewer.view_ws : glm::vec3(to_eye / length);
}

Image<float> specular_truth(const RayScene& scene, const SurfacePoints& points,
                            const Image<float>& roughness, const Viewer& viewer,
                            const TruthSettings& settings, const Progress& progress) {
  Image<float> out(points.normal_ws.width, points.normal_ws.height, 1.0f);
  for_each_surface(points, settings.seed, progress, [&](size_t pixel, uint64_t seed) {
    const Basis basis = make_basis(points.normal_ws.pixels[pixel]);
    const glm::vec3 view = view_from(viewer, points.position_ws.pixels[pixel]);
    const LobeSampler lobe(basis.to_local(view), roughness.pixels[pixel]);
    const Rays rays = trace_rays(
        scene, ray_start(scene, points, pixel), basis,
        [&](const glm::vec2& u) { return lobe.at(u); }, settings, seed);
    out.pixels[pixel] = rays.all > 0.0 ? static_cast<float>(rays.open / rays.all) : 1.0f;
  });
  return out;
}

Image<glm::vec3> interreflection_truth(const RayScene& scene, const SurfacePoints& points,
                                       const TruthSettings& settings, const Progress& progress) {
  Image<glm::vec3> out(points.normal_ws.width, points.normal_ws.height, glm::vec3(1.0f));
  const auto reflect = [&](const Hit& hit, const glm::vec3&, uint64_t bits) {
    const glm::vec2 u(unit_float(bits), unit_float(hash(bits, 3)));
    const Basis basis = make_basis(hit.geometric_normal_ws);
    return std::optional(
        Scattered{basis.to_world(cosine_direction(u)), albedo_at(scene.scene(), hit)});
  };
  for_each_surface(points, settings.seed, progress, [&](size_t pixel, uint64_t seed) {
    const Basis basis = make_basis(points.normal_ws.pixels[pixel]);
    const glm::vec3 origin = ray_start(scene, points, pixel);
    glm::dvec3 sum(0.0);
    for (uint32_t i = 0; i < settings.spp; ++i) {
      const glm::vec3 direction = basis.to_world(cosine_direction(r2_point(i, seed)));
      if (const auto end =
              follow_path(scene, origin, direction, settings.radius, hash(seed, i + 1), reflect))
        sum += end->weight;
    }
    out.pixels[pixel] = sum / static_cast<double>(settings.spp);
  });
  return out;
}

}  // namespace alcove::sample
