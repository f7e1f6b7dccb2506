#include "maths/ggx.h"

#include <gtest/gtest.h>

#include <cmath>

#include "quadrature.h"
#include "random_input.h"

namespace alcove::maths_test {
namespace {

using glm::vec3;

const vec3 kNormal(0, 0, 1);

vec3 at_angle(double angle) { return {float(std::sin(angle)), 0.0f, float(std::cos(angle))}; }

// Returns the GGX lobe without Fresnel: BRDF times the cosine of the light direction, per
// steradian.
float ggx_lobe(vec3 normal, vec3 view, vec3 light, float alpha) {
  const float n_dot_v = dot(normal, view), n_dot_l = dot(normal, light);
  if (n_dot_v <= 0.0f || n_dot_l <= 0.0f) return 0.0f;
  const float n_dot_h = glm::clamp(dot(normal, normalize(view + light)), 0.0f, 1.0f);
  return maths::ggx_distribution(n_dot_h, alpha) * maths::ggx_shadowing(n_dot_v, n_dot_l, alpha) /
         (4.0f * n_dot_v);
}

// Returns the integral of f(light) over the hemisphere. Narrow lobes are integrated over half
// vectors instead of light directions.
template <typename Function>
double over_hemisphere(Function f, int panels = 60) {
  return integrate(
      [&](double phi) {
        return integrate(
            [&](double theta) {
              const vec3 light(float(std::sin(theta) * std::cos(phi)),
                               float(std::sin(theta) * std::sin(phi)), float(std::cos(theta)));
              return double(f(light)) * std::sin(theta);
            },
            0.0, kPi / 2, panels);
      },
      0.0, 2 * kPi, panels);
}

TEST(Ggx, ProjectedMicrofacetAreaIntegratesToOneOverTheHemisphere) {
  for (const float alpha : {1e-3f, 0.01f, 0.1f, 0.5f, 1.0f}) {
    // The integration variable is log(tan(theta)), because the density of a narrow lobe extends
    // over many powers of ten of the tangent.
    const double sum = integrate(
        [&](double log_tan) {
          const double tan = std::exp(log_tan), cos = 1.0 / std::hypot(1.0, tan);
          const double n_dot_h = cos;
          // d(theta) = cos^2 d(tan) and d(tan) = tan d(log tan).
          return 2 * kPi * maths::ggx_distribution(float(n_dot_h), alpha) * cos * (tan * cos) *
                 cos * cos * tan;
        },
        std::log(1e-6), std::log(1e6), 200);
    // The cosine is a float, which near 1 cannot resolve the angles of a narrow lobe.
    EXPECT_NEAR(sum, 1.0, alpha < 0.005f ? 0.03 : 1e-3) << "alpha " << alpha;
  }
}

TEST(Ggx, MaskingFunctionIsOneAtNormalIncidenceAndDecreasesTowardsGrazingAngles) {
  for (const float alpha : {0.01f, 0.3f, 1.0f}) {
    EXPECT_FLOAT_EQ(maths::ggx_masking(1.0f, alpha), 1.0f);
    float before = 1.0f;
    for (float c = 1.0f; c >= 0.0f; c -= 0.01f) {
      const float g = maths::ggx_masking(c, alpha);
      EXPECT_LE(g, before + 1e-6f);
      EXPECT_GE(g, 0.0f);
      EXPECT_LE(maths::ggx_shadowing(c, 0.5f, alpha), g + 1e-6f);
      before = g;
    }
  }
}

TEST(Ggx, ReflectanceOfTheLobeIsAtMostOneForEveryViewAngle) {
  for (const float alpha : {0.2f, 0.5f, 1.0f}) {
    for (double angle : {0.0, 0.7, 1.2, 1.5}) {
      const double sum = over_hemisphere(
          [&](vec3 light) { return ggx_lobe(kNormal, at_angle(angle), light, alpha); });
      EXPECT_LE(sum, 1.001) << alpha << " " << angle;
      EXPECT_GE(sum, 0.3) << alpha << " " << angle;
    }
  }
}

TEST(Ggx, BrdfIsUnchangedWhenViewAndLightDirectionsAreSwapped) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const vec3 view = random.facing(kNormal), light = random.facing(kNormal);
    const float alpha = random.uniform(0.1f, 1.0f);
    const float there = ggx_lobe(kNormal, view, light, alpha) * view.z;
    const float back = ggx_lobe(kNormal, light, view, alpha) * light.z;
    EXPECT_NEAR(there, back, 1e-4f * there + 1e-6f);
  }
}

TEST(Ggx, ImportanceSamplesWeightedByTheirDensityReproduceTheIntegralOfTheLobe) {
  RandomInput random;
  for (const float alpha : {0.1f, 0.4f, 1.0f}) {
    for (double angle : {0.0, 0.8, 1.4}) {
      const vec3 view = at_angle(angle);
      // Tests importance sampling: the mean of lobe / density times a function, over samples, is
      // the integral of the lobe times that function.
      double sampled = 0.0, sampled_x = 0.0, squares = 0.0;
      constexpr int kSamples = 100000;
      for (int i = 0; i < kSamples; ++i) {
        const glm::vec2 numbers{random.uniform(0, 1), random.uniform(0, 1)};
        const vec3 h = maths::sample_ggx_normal(view, alpha, numbers.x, numbers.y);
        EXPECT_GE(h.z, 0.0f);
        const vec3 light = reflect(-view, h);
        if (light.z <= 0.0f) continue;
        const double weight = ggx_lobe(kNormal, view, light, alpha) /
                              maths::ggx_reflection_density(kNormal, view, light, alpha);
        EXPECT_LE(weight, 1.0001);
        sampled += weight;
        squares += weight * weight;
        sampled_x += weight * light.x;
      }
      const double total =
          over_hemisphere([&](vec3 light) { return ggx_lobe(kNormal, view, light, alpha); }, 120);
      const double total_x = over_hemisphere(
          [&](vec3 light) { return light.x * ggx_lobe(kNormal, view, light, alpha); }, 120);
      const double mean = sampled / kSamples;
      const double spread = std::sqrt((squares / kSamples - mean * mean) / kSamples);
      EXPECT_NEAR(mean, total, 5 * spread + 2e-3) << alpha << " " << angle;
      EXPECT_NEAR(sampled_x / kSamples, total_x, 5.0 / std::sqrt(kSamples) + 2e-3);
    }
  }
}

TEST(Ggx, LightDirectionSampledAtRoughnessZeroIsTheReflectedViewDirection) {
  const vec3 view = at_angle(1.0);
  const vec3 light = reflect(-view, maths::sample_ggx_normal(view, 0.0f, 0.3f, 0.4f));
  EXPECT_LT(distance(light, at_angle(-1.0)), 0.01f);
}

TEST(Ggx, GrazingViewsAndZeroRoughnessGiveFiniteResults) {
  for (const float alpha : {0.0f, 1e-30f, 1.0f}) {
    for (double angle : {0.0, kPi / 2 - 1e-4, kPi / 2}) {
      const vec3 view = at_angle(angle);
      EXPECT_TRUE(std::isfinite(ggx_lobe(kNormal, view, at_angle(-angle), alpha)));
      EXPECT_TRUE(std::isfinite(maths::ggx_reflection_density(kNormal, view, kNormal, alpha)));
      const vec3 h = maths::sample_ggx_normal(view, alpha, 0.999999f, 0.999999f);
      EXPECT_NEAR(length(h), 1.0f, 1e-4f);
    }
  }
}

}  // namespace
}  // namespace alcove::maths_test
