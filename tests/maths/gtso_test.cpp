#include "maths/gtso.h"

#include <gtest/gtest.h>

#include <cmath>

#include "quadrature.h"
#include "random_input.h"

namespace alcove::maths_test {
namespace {

using glm::vec3;

TEST(Gtso, CosineWeightedSolidAngleOfTheVisibilityConeEqualsTheVisibility) {
  for (float v = 0.0f; v <= 1.0f; v += 0.01f) {
    const double angle = maths::visibility_cone(v);
    const double cosine_weighted =
        integrate([](double t) { return 2 * std::sin(t) * std::cos(t); }, 0.0, angle);
    EXPECT_NEAR(cosine_weighted, v, 1e-5);
  }
}

TEST(Gtso, AlmostUnoccludedVisibilityIsRaisedToOneAndOtherValuesChangeByUnderOnePercent) {
  EXPECT_EQ(maths::converged_visibility(0.0f), 0.0f);
  EXPECT_EQ(maths::converged_visibility(127.5f / 128.0f), 1.0f);
  for (float v = 0.0f; v <= 1.0f; v += 0.01f)
    EXPECT_NEAR(maths::converged_visibility(v), v, 1.0f / 127.0f);
}

TEST(Gtso, BentNormalIsRaisedUntilTheVisibilityConeLiesAboveTheSurface) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const vec3 normal = random.unit_vector(), bent = random.facing(normal);
    const float v = random.uniform(0.0f, 1.0f);
    const vec3 raised = maths::raised_bent_normal(bent, normal, v);
    const float room = float(kPi) / 2 - maths::visibility_cone(v);
    EXPECT_NEAR(glm::length(raised), 1.0f, 1e-4f);
    EXPECT_LE(maths::angle_between(raised, normal), room + 1e-3f);
    if (maths::angle_between(bent, normal) < room - 1e-3f) {
      EXPECT_EQ(raised, bent);
    }
    EXPECT_LT(maths::angle_between(maths::raised_bent_normal(bent, normal, 1.0f), normal), 1e-3f);
  }
}

TEST(Gtso, MirrorDirectionIsAUnitVectorAboveTheSurface) {
  RandomInput random;
  for (int i = 0; i < 1000; ++i) {
    const vec3 normal = random.unit_vector(), view = random.unit_vector();
    const vec3 mirror = maths::mirror_direction(normal, view);
    EXPECT_NEAR(glm::length(mirror), 1.0f, 1e-4f);
    EXPECT_GE(glm::dot(mirror, normal), 0.0f);
    if (glm::dot(normal, view) > 1e-3f) {
      EXPECT_NEAR(glm::dot(mirror, normal), glm::dot(normal, view), 1e-5f);
    }
  }
}

}  // namespace
}  // namespace alcove::maths_test
