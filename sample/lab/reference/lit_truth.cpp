#include "reference/lit_truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "reference/sampling.h"
#include "support/parallel.h"

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
    const float alpha = std::max(roughness * roughness, 1e-4f);
    const glm::vec3 v(std::sqrt(1.0f - n_dot_v * n_dot_v), 0.0f, n_dot_v);
    glm::dvec2 sum(0.0);
    for (uint32_t i = 0; i < kSamples; ++i) {
      const glm::vec3 h = visible_normal(v, alpha, r2_point(i, 0));
      const glm::vec3 l = 2.0f * glm::dot(v, h) * h - v;
      if (l.z <= 0.0f) continue;
      const float share = (1.0f + ggx_lambda(v.z, alpha)) /
                          (1.0f + ggx_lambda(v.z, alpha) + ggx_lambda(l.z, alpha));
      const float fresnel = schlick(glm::dot(v, h));
      sum += glm::dvec2(share * (1.0f - fresnel), share * fresnel);
    }
    return sum / double(kSamples);
  }

  std::array<std::array<glm::vec2, kSide>, kSide> entries_;
};

// A surface point and its material. Directions are local, with z along the normal.
struct ShadingPoint {
  Basis basis;
  glm::vec3 view;  // local, z > 0
  glm::vec3 f0;
  float alpha;
  glm::vec3 diffuse;   // albedo of the Lambertian part, scaled by what the specular part leaves
  glm::vec3 specular;  // directional albedo of the specular part
};

ShadingPoint make_surface(const Reflectance& reflectance, const glm::vec3& normal,
                          const glm::vec3& view, const glm::vec3& base, float roughness,
                          float metallic) {
  ShadingPoint surface;
  surface.basis = make_basis(normal);
  surface.view = surface.basis.to_local(view);
  surface.view.z = std::max(surface.view.z, 1e-3f);
  surface.view = glm::normalize(surface.view);
  surface.f0 = glm::mix(glm::vec3(0.04f), base, metallic);
  surface.alpha = std::max(roughness * roughness, 1e-4f);
  surface.specular = reflectance.at(surface.view.z, roughness, surface.f0);
  surface.diffuse = base * (1.0f - metallic) * (1.0f - surface.specular);
  return surface;
}

// A sampled direction and its weight: BRDF times cosine over density.
struct Scattered {
  glm::vec3 direction_ws;
  glm::vec3 weight;
};

Scattered scatter_diffuse(const ShadingPoint& surface, const glm::vec2& u) {
  return {surface.basis.to_world(cosine_direction(u)), surface.diffuse};
}

std::optional<Scattered> scatter_specular(const ShadingPoint& surface, const glm::vec2& u) {
  const glm::vec3& v = surface.view;
  const glm::vec3 h = visible_normal(v, surface.alpha, u);
  const glm::vec3 l = 2.0f * glm::dot(v, h) * h - v;
  if (l.z <= 0.0f) return std::nullopt;
  const float masked = 1.0f + ggx_lambda(v.z, surface.alpha);
  const float share = masked / (masked + ggx_lambda(l.z, surface.alpha));
  const glm::vec3 fresnel = surface.f0 + (1.0f - surface.f0) * schlick(glm::dot(v, h));
  return Scattered{surface.basis.to_world(l), fresnel * share};
}

float largest(const glm::vec3& v) { return std::max({v.x, v.y, v.z}); }

class Tracer {
 public:
  Tracer(const RayScene& scene, const EnvironmentImage& environment, float radius)
      : scene_(scene), environment_(environment), radius_(radius) {}

  const Reflectance& reflectance() const { return reflectance_; }

  // The radiance that arrives from a direction.
  glm::vec3 trace(glm::vec3 origin, glm::vec3 direction, uint64_t seed) const {
    constexpr uint32_t kLongest = 256;
    glm::vec3 weight(1.0f);
    for (uint32_t bounce = 0; bounce < kLongest; ++bounce) {
      const std::optional<Hit> hit = scene_.nearest(origin, direction, radius_);
      if (!hit) return weight * radiance(environment_, direction);
      const uint64_t bits = hash(seed, bounce);
      const auto next = scatter(surface_at(*hit, direction), bits);
      if (!next) return glm::vec3(0.0f);
      weight *= next->weight;
      const float survival = std::min(largest(weight), 0.95f);
      if (bounce >= 2) {
        if (!(unit_float(hash(bits, 7)) < survival)) return glm::vec3(0.0f);
        weight /= survival;
      }
      origin = scene_.off_surface(origin + direction * hit->distance, hit->geometric_normal_ws);
      direction = next->direction_ws;
    }
    return glm::vec3(0.0f);
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
  const auto shade = [&](size_t pixel) {
    const glm::vec3& position = points.position_ws.pixels[pixel];
    const glm::vec3 view = view_from(viewer, position);
    const ShadingPoint surface = make_surface(
        tracer.reflectance(), points.normal_ws.pixels[pixel], view, materials.albedo.pixels[pixel],
        materials.roughness.pixels[pixel], materials.metallic.pixels[pixel]);
    const glm::vec3 origin = scene.off_surface(position, points.geometric_normal_ws.pixels[pixel]);
    HalfMeans diffuse, specular;
    const uint32_t samples = std::max(settings.spp / 2, 1u);
    for (uint32_t half = 0; half < 2; ++half) {
      const uint64_t seed = hash(hash(settings.seed, pixel), half);
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
  };
  parallel_rows(
      height,
      [&](uint32_t y) {
        for (size_t pixel = size_t{y} * width; pixel < size_t{y + 1} * width; ++pixel) {
          if (points.normal_ws.pixels[pixel] != glm::vec3(0.0f)) shade(pixel);
        }
      },
      progress);
  return out;
}

}  // namespace alcove::sample
