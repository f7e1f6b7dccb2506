#include "maths/split_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "maths/ggx.h"
#include "maths/packing.h"
#include "quadrature.h"
#include "random_input.h"
#include "tables.h"

namespace alcove::maths_test {
namespace {

using glm::uvec2;
using glm::vec2;
using glm::vec3;

// Looks up the table with the shader's interpolation.
vec2 look_up(const std::vector<std::uint32_t>& table, float n_dot_v, float roughness) {
  const vec2 at = maths::reflectance_coordinates(n_dot_v, roughness);
  const uvec2 low = min(uvec2(at), uvec2(maths::kReflectanceTable - 2));
  const vec2 t = at - vec2(low);
  const auto entry = [&](unsigned x, unsigned y) {
    const std::uint32_t word = table[(low.y + y) * maths::kReflectanceTable + low.x + x];
    return vec2(maths::unpack_unorm(word, 16), maths::unpack_unorm(word >> 16, 16));
  };
  return mix(mix(entry(0, 0), entry(1, 0), t.x), mix(entry(0, 1), entry(1, 1), t.x), t.y);
}

// Returns the integral of the lobe over the visible microfacets, by quadrature over their polar
// angle and azimuth.
vec2 quadrature(float n_dot_v, float roughness) {
  const float alpha = roughness * roughness;
  const vec3 view(std::sqrt(1.0f - n_dot_v * n_dot_v), 0.0f, n_dot_v);
  struct Sum {
    double x, y;
    Sum operator+(const Sum& o) const { return {x + o.x, y + o.y}; }
    Sum& operator+=(const Sum& o) { return *this = *this + o; }
  };
  const auto mean = [&](double u1, double u2) {
    const vec3 h = maths::sample_ggx_normal(view, alpha, float(u1), float(u2));
    const vec3 light = reflect(-view, h);
    if (light.z <= 0.0f) return Sum{0, 0};
    const double share =
        maths::ggx_shadowing(n_dot_v, light.z, alpha) / maths::ggx_masking(n_dot_v, alpha);
    const double fresnel = std::pow(1.0 - std::max(dot(view, h), 0.0f), 5.0);
    return Sum{share * (1 - fresnel), share * fresnel};
  };
  Sum sum{0, 0};
  constexpr int kSide = 192;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) sum += mean((i + 0.5) / kSide, (j + 0.5) / kSide);
  return vec2(float(sum.x), float(sum.y)) / float(kSide * kSide);
}

TEST(SplitSum, InterpolatedReflectanceTableIsCloseToTheIntegral) {
  const auto table = alcove::passes::reflectance_table();
  RandomInput random(1);  // a fixed set, because the README states its figures
  double worst = 0.0, squares = 0.0;
  constexpr int kPoints = 1000;
  for (int i = 0; i < kPoints; ++i) {
    // Every fifth view is at a grazing angle, where the table changes fastest.
    const float n_dot_v = std::max(random.uniform(0.0f, i % 5 == 0 ? 0.03f : 1.0f), 1e-3f);
    const float roughness = random.uniform(0.0f, 1.0f);
    const vec2 error = look_up(table, n_dot_v, roughness) - quadrature(n_dot_v, roughness);
    for (const float e : {error.x, error.y, error.x + error.y}) {
      worst = std::max(worst, double(std::abs(e)));
      squares += e * e / 3.0;
    }
  }
  const double rmse = std::sqrt(squares / kPoints);
  std::cout << "reflectance table: max " << worst << ", RMSE " << rmse << "\n";
  EXPECT_LT(worst, 0.015);
  EXPECT_LT(rmse, 0.001);
}

TEST(SplitSum, SpecularReflectanceOfAWhiteSurfaceIsAtMostOne) {
  const auto table = alcove::passes::reflectance_table();
  for (int x = 0; x <= 100; ++x) {
    for (int y = 0; y <= 100; ++y) {
      const vec2 value = look_up(table, float(x) / 100.0f, float(y) / 100.0f);
      const vec3 white = maths::specular_reflectance(vec3(1), value);
      EXPECT_LE(white.x, 1.0f);
      EXPECT_GT(white.x, 0.25f);
    }
  }
  EXPECT_NEAR(maths::specular_reflectance(vec3(1), look_up(table, 1.0f, 0.0f)).x, 1.0f, 1e-3f);
}

// Returns the radiance of a test environment: bright above, dark below, and brightest on one side.
double light_from(vec3 d) {
  return (d.y > 0.0f ? 1.0 : 0.25) + 4.0 * std::exp(10.0 * (dot(d, vec3(0.6f, 0.8f, 0.0f)) - 1.0));
}

// Returns the mean radiance over the lobe around `normal` seen from `view`, by evenly distributed
// microfacets.
double lobe_light(vec3 normal, vec3 view, float alpha) {
  const vec3 x =
      normalize(cross(std::abs(normal.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0), normal));
  const glm::mat3 world(x, cross(normal, x), normal);
  const vec3 v = transpose(world) * view;
  double sum = 0.0, weights = 0.0;
  constexpr int kSamples = 1024;
  for (int i = 0; i < kSamples; ++i) {
    const double fraction = std::fmod(0.5 + i * 0.6180339887498949, 1.0);
    const vec3 h =
        maths::sample_ggx_normal(v, alpha, float(fraction), (float(i) + 0.5f) / float(kSamples));
    const vec3 light = reflect(-v, h);
    if (light.z <= 0.0f) continue;
    const double weight =
        maths::ggx_shadowing(v.z, light.z, alpha) / maths::ggx_masking(v.z, alpha);
    sum += weight * light_from(world * light);
    weights += weight;
  }
  return sum / weights;
}

TEST(SplitSum, LookingUpTheDominantDirectionHalvesTheErrorOfRoughReflections) {
  RandomInput random;
  for (const float roughness : {0.6f, 0.8f, 1.0f}) {
    double mirror_squares = 0.0, squares = 0.0;
    for (int i = 0; i < 300; ++i) {
      const vec3 normal = random.unit_vector(), view = random.facing(normal);
      if (dot(normal, view) < 0.02f) continue;
      const float alpha = roughness * roughness;
      const double truth = lobe_light(normal, view, alpha);
      const vec3 mirror = reflect(-view, normal);
      const vec3 dominant = maths::dominant_direction(normal, mirror, roughness);
      mirror_squares += std::pow(lobe_light(mirror, mirror, alpha) - truth, 2);
      squares += std::pow(lobe_light(dominant, dominant, alpha) - truth, 2);
    }
    EXPECT_LT(squares, 0.4 * mirror_squares) << roughness;
  }
  EXPECT_LT(distance(maths::dominant_direction(vec3(0, 0, 1), vec3(0.6f, 0, 0.8f), 0.0f),
                     vec3(0.6f, 0, 0.8f)),
            1e-6f)
      << "mirrors keep their direction";
}

TEST(SplitSum, MetalsHaveNoDiffuseAlbedoAndDielectricsReflectFourPercent) {
  const vec3 base(0.9f, 0.5f, 0.1f);
  EXPECT_EQ(maths::diffuse_albedo(base, 1.0f), vec3(0));
  EXPECT_EQ(maths::diffuse_albedo(base, 0.0f), base);
  EXPECT_EQ(maths::normal_reflectance(base, 1.0f), base);
  EXPECT_EQ(maths::normal_reflectance(base, 0.0f), vec3(maths::kDielectricReflectance));
  EXPECT_EQ(maths::normal_reflectance(base, 3.0f), base) << "out of range";
}

}  // namespace
}  // namespace alcove::maths_test
