#include "reference/lit_truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "reference/path.h"

namespace alcove::sample {
namespace {

float schlick(float cosine) {
  const float rest = 1.0f - std::clamp(cosine, 0.0f, 1.0f);
  return rest * rest * rest * rest * rest;
}

// The directional albedo of GGX, scale * f0 + offset, tabulated over N.V and roughness.
class Reflectance {
 public:
  Reflectance() {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const float root = static_cast<float>(x) / (kSide - 1);
        entries_[y][x] =
            integrate(std::max(root * root, 1e-3f), static_cast<float>(y) / (kSide - 1));
      }
    }
  }

  glm::vec3 at(float n_dot_v, float roughness, const glm::vec3& f0) const {
    const float x = std::sqrt(std::clamp(n_dot_v, 0.0f, 1.0f)) * (kSide - 1);
    const float y = std::clamp(roughness, 0.0f, 1.0f) * (kSide - 1);
    const int i = std::min(static_cast<int>(x), kSide - 2);
    const int j = std::min(static_cast<int>(y), kSide - 2);
    const float s = x - static_cast<float>(i), t = y - static_cast<float>(j);
    const glm::vec2 value = glm::mix(glm::mix(entries_[j][i], entries_[j][i + 1], s),
                                     glm::mix(entries_[j + 1][i], entries_[j + 1][i + 1], s), t);
    return f0 * value.x + value.y;
  }

 private:
  static constexpr int kSide = 32;

  static glm::vec2 integrate(float n_dot_v, float roughness) {
    constexpr uint32_t kSamples = 1024;
    const LobeSampler lobe({std::sqrt(1.0f - n_dot_v * n_dot_v), 0.0f, n_dot_v}, roughness);
    glm::dvec2 sum(0.0);
    for (uint32_t i = 0; i < kSamples; ++i) {
      const LobeSample light = lobe.at(r2_point(i, 0));
      const float fresnel = schlick(light.half_cosine);
      sum += glm::dvec2(light.weight * (1.0f - fresnel), light.weight * fresnel);
    }
    return sum / double(kSamples);
  }

  std::array<std::array<glm::vec2, kSide>, kSide> entries_;
};

// A surface point and its material.
struct ShadingPoint {
  Basis basis;
  LobeSampler lobe;
  glm::vec3 f0;
  glm::vec3 diffuse;   // albedo of the Lambertian part, scaled by what the specular part leaves
  glm::vec3 specular;  // directional albedo of the specular part
};

ShadingPoint make_surface(const Reflectance& reflectance, const glm::vec3& normal,
                          const glm::vec3& view, const glm::vec3& base, float roughness,
                          float metallic) {
  const Basis basis = make_basis(normal);
  const LobeSampler lobe(basis.to_local(view), roughness);
  const glm::vec3 f0 = glm::mix(glm::vec3(0.04f), base, metallic);
  const glm::vec3 specular = reflectance.at(lobe.view().z, roughness, f0);
  return {basis, lobe, f0, base * (1.0f - metallic) * (1.0f - specular), specular};
}

Scattered scatter_diffuse(const ShadingPoint& surface, const glm::vec2& u) {
  return {surface.basis.to_world(cosine_direction(u)), surface.diffuse};
}

std::optional<Scattered> scatter_specular(const ShadingPoint& surface, const glm::vec2& u) {
  const LobeSample light = surface.lobe.at(u);
  if (light.weight <= 0.0f) return std::nullopt;
  const glm::vec3 fresnel = surface.f0 + (1.0f - surface.f0) * schlick(light.half_cosine);
  return Scattered{surface.basis.to_world(light.direction), fresnel * light.weight};
}

float largest(const glm::vec3& v) { return std::max({v.x, v.y, v.z}); }

class Tracer {
 public:
  Tracer(const RayScene& scene, const EnvironmentImage& environment, float radius)
      : scene_(scene), environment_(environment), radius_(radius) {}

  const Reflectance& reflectance() const { return reflectance_; }

  // The radiance that arrives from a direction.
  glm::vec3 trace(const glm::vec3& origin, const glm::vec3& direction, uint64_t seed) const {
    const auto end = follow_path(scene_, origin, direction, radius_, seed,
                                 [&](const Hit& hit, const glm::vec3& from, uint64_t bits) {
                                   return scatter(surface_at(hit, from), bits);
                                 });
    return end ? end->weight * radiance(environment_, end->direction_ws) : glm::vec3(0.0f);
  }

 private:
  ShadingPoint surface_at(const Hit& hit, const glm::vec3& direction) const {
    const Scene& scene = scene_.scene();
    const Material& material = scene.materials[hit.material];
    const glm::vec4 texel = sample_texture(scene, material.metal_roughness_texture, hit.uvs);
    return make_surface(reflectance_, hit.geometric_normal_ws, -direction, albedo_at(scene, hit),
                        material.roughness * texel.g, material.metallic * texel.b);
  }

  // Samples one of the two parts, chosen by their albedos. Empty if the path ends.
  static std::optional<Scattered> scatter(const ShadingPoint& surface, uint64_t bits) {
    const float diffuse = largest(surface.diffuse), specular = largest(surface.specular);
    const float chance = specular / std::max(diffuse + specular, 1e-6f);
    const glm::vec2 u(unit_float(bits), unit_float(hash(bits, 3)));
    if (unit_float(hash(bits, 5)) >= chance) {
      Scattered out = scatter_diffuse(surface, u);
      out.weight /= 1.0f - chance;
      return out;
    }
    auto out = scatter_specular(surface, u);
    if (out) out->weight /= chance;
    return out;
  }

  const RayScene& scene_;
  const EnvironmentImage& environment_;
  float radius_;
  Reflectance reflectance_;
};

// Means of two independent halves of the samples.
struct HalfMeans {
  std::array<glm::dvec3, 2> means{glm::dvec3(0.0), glm::dvec3(0.0)};
  glm::vec3 mean() const { return 0.5 * (means[0] + means[1]); }
  glm::vec3 half_difference() const { return 0.5 * (means[0] - means[1]); }
};

}  // namespace

LitTruth lit_truth(const RayScene& scene, const SurfacePoints& points,
                   const SurfaceMaterials& materials, const Viewer& viewer,
                   const EnvironmentImage& environment, const TruthSettings& settings,
                   const Progress& progress) {
  const uint32_t width = points.normal_ws.width, height = points.normal_ws.height;
  LitTruth out{{width, height}, {width, height}, {width, height}, {width, height}};
  const Tracer tracer(scene, environment, settings.radius);
  for_each_surface(points, settings.seed, progress, [&](size_t pixel, uint64_t pixel_seed) {
    const glm::vec3 view = view_from(viewer, points.position_ws.pixels[pixel]);
    const ShadingPoint surface = make_surface(
        tracer.reflectance(), points.normal_ws.pixels[pixel], view, materials.albedo.pixels[pixel],
        materials.roughness.pixels[pixel], materials.metallic.pixels[pixel]);
    const glm::vec3 origin = ray_start(scene, points, pixel);
    HalfMeans diffuse, specular;
    const uint32_t samples = std::max(settings.spp / 2, 1u);
    for (uint32_t half = 0; half < 2; ++half) {
      const uint64_t seed = hash(pixel_seed, half);
      for (uint32_t i = 0; i < samples; ++i) {
        const glm::vec2 u = r2_point(i, seed);
        const Scattered diffused = scatter_diffuse(surface, u);
        diffuse.means[half] += diffused.weight * tracer.trace(origin, diffused.direction_ws,
                                                              hash(seed, uint64_t{2} * i));
        if (const auto mirrored = scatter_specular(surface, u))
          specular.means[half] += mirrored->weight * tracer.trace(origin, mirrored->direction_ws,
                                                                  hash(seed, uint64_t{2} * i + 1));
      }
      diffuse.means[half] /= double(samples);
      specular.means[half] /= double(samples);
    }
    out.diffuse.pixels[pixel] = diffuse.mean();
    out.specular.pixels[pixel] = specular.mean();
    out.diffuse_noise.pixels[pixel] = diffuse.half_difference();
    out.specular_noise.pixels[pixel] = specular.half_difference();
  });
  return out;
}

}  // namespace alcove::sample
