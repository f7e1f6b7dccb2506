#include "maths/bent_normal.h"

#include <gtest/gtest.h>

#include <cmath>

#include "random_input.h"
#include "slice_truth.h"

namespace alcove::maths_test {
namespace {

using glm::vec3;
using maths::Slice;

TEST(BentNormal, ArcAgreesWithQuadratureForEveryNormalAndHorizon) {
  double worst = 0.0;
  for_each_slice_and_horizon([&](const Slice& s, const SliceTruth& truth, float c) {
    const glm::dvec2 ahead = truth.bent(0.0, std::acos(double(c)));
    const glm::dvec2 behind = truth.bent(-std::acos(double(c)), 0.0);
    worst = std::max(worst, distance(glm::dvec2(maths::bent_arc(s, 1.0f, c)), ahead));
    worst = std::max(worst, distance(glm::dvec2(maths::bent_arc(s, -1.0f, c)), behind));
  });
  EXPECT_LT(worst, 1e-6);
}

TEST(BentNormal, IsTheMemosFormInAngles) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const double g = random.uniform(-1.5f, 1.5f);
    const double h1 = random.uniform(0.0f, float(g + kPi / 2));
    const double h2 = random.uniform(float(g - kPi / 2), 0.0f);
    const double t0 =
        (6 * std::sin(h2 - g) - std::sin(3 * h2 - g) + 6 * std::sin(h1 - g) - std::sin(3 * h1 - g) +
         16 * std::sin(g) - 3 * (std::sin(h2 + g) + std::sin(h1 + g))) /
        12;
    const double t1 = (-std::cos(3 * h2 - g) - std::cos(3 * h1 - g) + 8 * std::cos(g) -
                       3 * (std::cos(h2 + g) + std::cos(h1 + g))) /
                      12;
    const vec3 bent = maths::slice_bent_normal(slice_of(1.0, g), vec3(1, 0, 0), vec3(0, 0, 1),
                                               float(std::cos(h1)), float(std::cos(h2)));
    EXPECT_NEAR(bent.x, t0, 2e-6);
    EXPECT_NEAR(bent.z, t1, 2e-6);
  }
}

TEST(BentNormal, OfAnOpenSurfaceIsItsNormal) {
  RandomInput random;
  for (int i = 0; i < 200; ++i) {
    const vec3 view = random.facing(vec3(0, 0, 1)), normal = random.facing(view);
    const maths::ViewBasis basis = maths::make_view_basis(view);
    vec3 sum(0);
    for (int k = 0; k < 512; ++k) {
      const vec3 direction = maths::slice_direction(basis, float(kPi * (k + 0.5) / 512));
      const Slice s = maths::make_slice(normal, direction, view);
      sum += maths::slice_bent_normal(s, direction, view, -1.0f, -1.0f);
    }
    EXPECT_LT(distance(maths::finish_bent_normal(sum, view), normal), 2e-4f);
  }
}

TEST(BentNormal, LeansAwayFromAWall) {
  const vec3 view(0, 0, 1);
  const Slice s = maths::make_slice(view, vec3(1, 0, 0), view);
  const vec3 bent = maths::slice_bent_normal(s, vec3(1, 0, 0), view, 0.8f, -1.0f);
  EXPECT_LT(bent.x, -0.1f);
  EXPECT_GT(bent.z, 0.1f);
}

TEST(BentNormal, FallsBackToTheNormalWhereNothingIsVisible) {
  const vec3 normal(0, 1, 0);
  EXPECT_EQ(maths::finish_bent_normal(vec3(0), normal), normal);
  EXPECT_EQ(maths::finish_bent_normal(vec3(1e-30f), normal), normal);
  const Slice s = maths::make_slice(vec3(0, 0, 1), vec3(1, 0, 0), vec3(0, 0, 1));
  EXPECT_EQ(maths::slice_bent_normal(s, vec3(1, 0, 0), vec3(0, 0, 1), 1.0f, 1.0f), vec3(0));
}

}  // namespace
}  // namespace alcove::maths_test
