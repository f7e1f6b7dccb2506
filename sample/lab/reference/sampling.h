#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/gtc/constants.hpp>

#include "support/glm.h"

namespace alcove::sample {

// Random numbers and directions for the ray-traced truths. This file shares no code with
// shaders/maths, because the truths check that code.

// A 64-bit mix of two integers (the finaliser of splitmix64, twice).
[[nodiscard]] inline uint64_t hash(uint64_t a, uint64_t b) {
  const auto mix = [](uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
  };
  return mix(mix(a + 0x9e3779b97f4a7c15u) + b * 0xda942042e4dd58b5u);
}

// In [0, 1), with 24 bits.
[[nodiscard]] inline float unit_float(uint64_t bits) {
  return static_cast<float>(bits >> 40) * 0x1p-24f;
}

// Returns point i of Roberts' R2 sequence with a Cranley-Patterson shift. The points are evenly
// distributed for any number of them. They are computed in fixed point, so that large i lose no
// precision.
[[nodiscard]] inline glm::vec2 r2_point(uint32_t i, uint64_t shift) {
  constexpr uint64_t kA = 0xc13fa9a902a6328fu;  // 2^64 / 1.32471795724...
  constexpr uint64_t kB = 0x91e10da5c79e7b1du;  // 2^64 / 1.32471795724...^2
  const uint64_t second = hash(shift, 1);
  return {unit_float(shift + i * kA), unit_float(second + i * kB)};
}

// A right-handed orthonormal basis (x, y, n).
struct Basis {
  glm::vec3 x, y, n;
  glm::vec3 to_world(const glm::vec3& v) const { return v.x * x + v.y * y + v.z * n; }
  glm::vec3 to_local(const glm::vec3& v) const {
    return {glm::dot(v, x), glm::dot(v, y), glm::dot(v, n)};
  }
};
[[nodiscard]] inline Basis make_basis(const glm::vec3& n) {
  const glm::vec3 helper = std::abs(n.x) < 0.6f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  const glm::vec3 x = glm::normalize(glm::cross(helper, n));
  return {x, glm::cross(n, x), n};
}

// A cosine-weighted direction about +z: density cos / pi.
[[nodiscard]] inline glm::vec3 cosine_direction(const glm::vec2& u) {
  const float r = std::sqrt(u.x), phi = glm::two_pi<float>() * u.y;
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0f, 1.0f - u.x))};
}

// Returns a normal sampled from the GGX distribution of normals visible from `v` (local space, v.z
// > 0; Heitz 2018, "Sampling the GGX Distribution of Visible Normals", section 3).
[[nodiscard]] inline glm::vec3 visible_normal(const glm::vec3& v, float alpha, const glm::vec2& u) {
  const glm::vec3 vh = glm::normalize(glm::vec3(alpha * v.x, alpha * v.y, v.z));
  const float across = vh.x * vh.x + vh.y * vh.y;
  const glm::vec3 t1 =
      across > 0.0f ? glm::vec3(-vh.y, vh.x, 0.0f) / std::sqrt(across) : glm::vec3(1, 0, 0);
  const glm::vec3 t2 = glm::cross(vh, t1);
  const float r = std::sqrt(u.x), phi = glm::two_pi<float>() * u.y;
  const float a = r * std::cos(phi);
  const float s = 0.5f * (1.0f + vh.z);
  const float b = (1.0f - s) * std::sqrt(1.0f - a * a) + s * r * std::sin(phi);
  const glm::vec3 nh = a * t1 + b * t2 + std::sqrt(std::max(0.0f, 1.0f - a * a - b * b)) * vh;
  return glm::normalize(glm::vec3(alpha * nh.x, alpha * nh.y, std::max(1e-7f, nh.z)));
}

// Smith's lambda of GGX for a direction with cosine `z` above the surface.
[[nodiscard]] inline float ggx_lambda(float z, float alpha) {
  const float z2 = std::max(z * z, 1e-12f);
  return 0.5f * (std::sqrt(1.0f + alpha * alpha * (1.0f - z2) / z2) - 1.0f);
}

// A sampled direction of a GGX lobe and its weight.
struct LobeSample {
  glm::vec3 direction;  // local
  float weight;         // 0 below the surface
  float half_cosine;    // of the angle between view and microfacet, for Fresnel
};

// Samples the GGX lobe of a view direction, with Smith's height-correlated masking and without
// Fresnel, by visible normals. Weighted means over its samples are means with weight BRDF times
// cosine.
class LobeSampler {
 public:
  // `view`: unit, local. A direction below the horizon, caused by interpolation, is clamped to it.
  LobeSampler(glm::vec3 view, float roughness) : alpha_(std::max(roughness * roughness, 1e-4f)) {
    view.z = std::max(view.z, 1e-3f);
    view_ = glm::normalize(view);
    view_lambda_ = ggx_lambda(view_.z, alpha_);
  }
  [[nodiscard]] const glm::vec3& view() const { return view_; }
  [[nodiscard]] LobeSample at(const glm::vec2& u) const {
    const glm::vec3 h = visible_normal(view_, alpha_, u);
    const float cosine = glm::dot(view_, h);
    const glm::vec3 l = 2.0f * cosine * h - view_;
    if (l.z <= 0.0f) return {l, 0.0f, cosine};
    // BRDF times cosine over density: the masking of l given that of the view.
    return {l, (1.0f + view_lambda_) / (1.0f + view_lambda_ + ggx_lambda(l.z, alpha_)), cosine};
  }

 private:
  float alpha_;
  glm::vec3 view_;
  float view_lambda_;
};

}  // namespace alcove::sample
