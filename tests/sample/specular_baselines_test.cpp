#include "reference/specular_baselines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/gtc/constants.hpp>

#include "evaluate/errors.h"
#include "reference/sampling.h"
#include "reference/visibility_polynomials.h"
#include "scene/analytic_scenes.h"

namespace alcove::sample {
namespace {

// The means over cosine-weighted directions of a function times each polynomial, by quadrature.
VisibilityPolynomials project(const std::function<float(const glm::vec3&)>& function) {
  constexpr int kRings = 256, kAzimuths = 256;
  VisibilityPolynomials sum{};
  for (int i = 0; i < kRings; ++i) {
    const float squared = (static_cast<float>(i) + 0.5f) / kRings;
    for (int j = 0; j < kAzimuths; ++j) {
      const float phi = glm::two_pi<float>() * (static_cast<float>(j) + 0.5f) / kAzimuths;
      const float r = std::sqrt(squared);
      const glm::vec3 d(r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0f - squared));
      add_weighted(sum, visibility_polynomials(d), function(d) / (kRings * kAzimuths));
    }
  }
  return sum;
}

// A thousand evenly distributed directions of the hemisphere.
constexpr uint32_t kDirections = 1000;
glm::vec3 spread_direction(uint32_t i) { return cosine_direction(r2_point(i, 1)); }

TEST(VisibilityPolynomials, PolynomialsAreOrthonormalOverACosineWeightedHemisphere) {
  for (std::size_t i = 0; i < kVisibilityPolynomials; ++i) {
    const VisibilityPolynomials products =
        project([&](const glm::vec3& d) { return visibility_polynomials(d)[i]; });
    for (std::size_t j = 0; j < kVisibilityPolynomials; ++j) {
      EXPECT_NEAR(products[j], i == j ? 1.0f : 0.0f, 1e-3f) << i << " " << j;
    }
  }
}

TEST(VisibilityPolynomials, VisibleFractionOfALobeIsBetweenZeroAndOneAndExactAtBothEnds) {
  VisibilityPolynomials all{};
  all[0] = 1.0f;
  for (uint32_t i = 0; i < kDirections; ++i) {
    const VisibilityPolynomials lobe = visibility_polynomials(spread_direction(i));
    EXPECT_EQ(visible_share({}, lobe), 1.0f);
    EXPECT_EQ(visible_share(all, lobe), 0.0f);
    VisibilityPolynomials any{};
    for (std::size_t j = 0; j < any.size(); ++j) any[j] = unit_float(hash(i, j)) * 4.0f - 2.0f;
    EXPECT_GE(visible_share(any, lobe), 0.0f);
    EXPECT_LE(visible_share(any, lobe), 1.0f);
  }
}

TEST(VisibilityPolynomials, ProjectionOfAHalfOccludedHemisphereMatchesTheClosedForm) {
  const VisibilityPolynomials half =
      project([](const glm::vec3& d) { return d.x > 0.0f ? 1.0f : 0.0f; });
  EXPECT_NEAR(half[0], 0.5f, 1e-4f);
  EXPECT_NEAR(half[1], 4.0f / (3.0f * glm::pi<float>()), 1e-3f);
  EXPECT_NEAR(half[2], 0.0f, 1e-4f);
  // Half of any lobe that is symmetric about the normal is visible.
  for (const float squared : {0.0f, 0.2f, 0.7f}) {
    VisibilityPolynomials ring{};
    for (int j = 0; j < 64; ++j) {
      const float phi = glm::two_pi<float>() * static_cast<float>(j) / 64, r = std::sqrt(squared);
      add_weighted(
          ring,
          visibility_polynomials({r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0f - squared)}),
          1.0f / 64);
    }
    EXPECT_NEAR(visible_share(half, ring), 0.5f, 1e-3f) << squared;
  }
}

TEST(VisibilityPolynomials, VisibilityThatIsAPolynomialIsReproducedByItsProjection) {
  const auto hidden = [](const glm::vec3& d) {
    return 0.4f + 0.1f * d.x - 0.1f * d.y * d.x + 0.1f * d.x * d.x * d.y +
           0.1f * d.y * d.y * d.y * d.x;
  };
  const VisibilityPolynomials numbers = project(hidden);
  for (uint32_t i = 0; i < kDirections; ++i) {
    const glm::vec3 d = spread_direction(i);
    EXPECT_NEAR(visible_share(numbers, visibility_polynomials(d)), 1.0f - hidden(d), 2e-3f);
  }
}

// The baselines and the truth of the middle of a view of a scene.
struct Limits {
  SpecularBaselines baselines;
  Image<float> truth;
  Mask mask;
};
Limits limits_of(const char* name, float roughness, const TruthSettings& settings) {
  constexpr uint32_t kWidth = 240, kHeight = 136;
  const auto analytic = analytic_scene(name);
  const auto rays = RayScene::create(analytic->scene);
  const Camera& camera = analytic->scene.cameras[0];
  const GBuffer g = cast_gbuffer(*rays, camera, kWidth, kHeight);
  SurfacePoints points{g.position_ws, {kWidth, kHeight, glm::vec3(0.0f)}, g.geometric_normal_ws};
  Mask mask(kWidth, kHeight);
  for (uint32_t y = 56; y < 80; ++y) {
    for (uint32_t x = 100; x < 140; ++x) {
      points.normal_ws.at(x, y) = g.geometric_normal_ws.at(x, y);
      mask.at(x, y) = std::isfinite(g.depth_vs.at(x, y)) ? 1 : 0;
    }
  }
  const Image<float> image(kWidth, kHeight, roughness);
  return {specular_baselines(*rays, points, g.depth_vs, camera, {image}, settings).front(),
          specular_truth(*rays, points, image, viewer_of(camera), settings), mask};
}

TEST(SpecularBaselines, UnoccludedPlaneHasSpecularVisibilityOneAtAnyTiltAndRoughness) {
  for (const char* name : {"plane:0", "plane:45", "plane:75"}) {
    for (const float roughness : {0.05f, 0.3f, 1.0f}) {
      const Limits all = limits_of(name, roughness, {0.5f, 64, 1});
      const Image<float> open(all.mask.width, all.mask.height, 1.0f);
      for (const Image<float>* one :
           {&all.baselines.polynomials, &all.baselines.depth, &all.baselines.depth_polynomials}) {
        const ErrorSummary error = compare_images(*one, open, all.mask);
        EXPECT_GT(error.count, 900u);
        EXPECT_EQ(error.max_absolute, 0.0) << name << " " << roughness;
      }
    }
  }
}

TEST(SpecularBaselines,
     BaselinesAgreeWithTheRayTracedTruthForWideLobesIfTheImageShowsAllOccluders) {
  for (const char* name : {"groove:90", "groove:120", "step"}) {
    const Limits all = limits_of(name, 0.8f, {0.4f, 256, 1});
    const Image<float> open(all.mask.width, all.mask.height, 1.0f);
    EXPECT_GT(compare_images(open, all.truth, all.mask).rmse, 0.05) << name;
    EXPECT_LT(compare_images(all.baselines.polynomials, all.truth, all.mask).rmse, 0.02) << name;
    EXPECT_LT(compare_images(all.baselines.depth, all.truth, all.mask).rmse, 0.03) << name;
    EXPECT_LT(compare_images(all.baselines.depth_polynomials, all.truth, all.mask).rmse, 0.03)
        << name;
  }
}

}  // namespace
}  // namespace alcove::sample
