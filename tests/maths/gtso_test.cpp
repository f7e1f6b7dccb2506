#include "maths/gtso.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "quadrature.h"
#include "random_input.h"

namespace alcove::maths_test {
namespace {

using glm::vec3;

const vec3 kNormal(0, 0, 1);

// Returns the area of the intersection of two caps by integration over rings around the axis of
// `a`: each ring at angle t contributes the arc inside `b`.
double shared_area(double a, double b, double d) {
  const auto ring = [&](double t) {
    const double across = std::sin(t) * std::sin(d), along = std::cos(t) * std::cos(d);
    double half_arc = 0.0;
    if (across < 1e-15)
      half_arc = along >= std::cos(b) ? kPi : 0.0;
    else
      half_arc = std::acos(std::clamp((std::cos(b) - along) / across, -1.0, 1.0));
    return 2 * half_arc * std::sin(t);
  };
  // The integral is split at the angles at which the ring crosses the rim of `b`.
  const double k1 = std::clamp(std::abs(d - b), 0.0, a), k2 = std::clamp(d + b, k1, a);
  return integrate(ring, 0.0, k1, 200) + integrate(ring, k1, k2, 2000) +
         integrate(ring, k2, a, 200);
}

TEST(SphericalCap, IntersectionAreaOfTwoCapsAgreesWithQuadrature) {
  RandomInput random;
  for (int i = 0; i < 1500; ++i) {
    const double a = random.log_uniform(1e-3f, 1.5707f), b = random.log_uniform(1e-3f, 1.5707f);
    const double d = i % 2 == 0 ? random.uniform(0.0f, 3.14f)
                                : random.uniform(float(std::abs(a - b)), float(a + b));
    const double expected = shared_area(a, b, d);
    const double whole = 2 * kPi * (1 - std::cos(std::min(a, b)));
    EXPECT_NEAR(maths::cap_intersection(float(a), float(b), float(d)) / whole, expected / whole,
                1e-6 / std::min(a, b) + 1e-5)
        << "a " << a << " b " << b << " d " << d;
  }
}

TEST(SphericalCap, IntersectionAreaIsContinuousWhereCapsTouchOrContainEachOther) {
  for (const float a : {0.01f, 0.3f, 1.2f, 1.5707f}) {
    for (const float b : {0.02f, 0.5f, 1.5707f}) {
      const float whole = maths::cap_area(std::min(a, b));
      EXPECT_NEAR(maths::cap_intersection(a, b, std::abs(a - b) + 1e-5f * (a + b)) / whole, 1.0f,
                  0.01f);
      EXPECT_NEAR(maths::cap_intersection(a, b, (a + b) * (1 - 1e-5f)) / whole, 0.0f, 0.01f);
      EXPECT_EQ(maths::cap_intersection(a, b, a + b + 1e-4f), 0.0f);
      EXPECT_EQ(maths::cap_intersection(a, b, 0.0f), whole);
    }
  }
}

TEST(Gtso, CosineWeightedSolidAngleOfTheVisibilityConeEqualsTheVisibility) {
  for (float v = 0.0f; v <= 1.0f; v += 0.01f) {
    const double angle = maths::visibility_cone(v);
    const double cosine_weighted =
        integrate([](double t) { return 2 * std::sin(t) * std::cos(t); }, 0.0, angle);
    EXPECT_NEAR(cosine_weighted, v, 1e-5);
  }
}

TEST(Gtso, ConeOfTheSpecularLobeHasTheHalfAngleOfThePaper) {
  for (float alpha = 0.0f; alpha <= 1.0f; alpha += 0.001f) {
    const double expected = std::acos(std::pow(10.0, -double(alpha) * alpha));
    EXPECT_NEAR(maths::lobe_cone(alpha), expected, 1e-5 + 2e-5 * expected);
  }
}

TEST(Gtso, UnoccludedSurfaceHasSpecularVisibilityOneForEveryRoughnessAndViewAngle) {
  for (float alpha : {0.0f, 1e-3f, 0.01f, 0.1f, 0.3f, 1.0f})
    for (double angle = 0.0; angle <= 89.9; angle += 0.7) {
      const double t = angle * kPi / 180;
      const vec3 reflection(float(std::sin(t)), 0, float(std::cos(t)));
      EXPECT_NEAR(maths::specular_occlusion(1.0f, kNormal, kNormal, reflection, alpha), 1.0f, 1e-4f)
          << alpha << " " << angle;
    }
}

TEST(Gtso, FullyOccludedSurfaceHasSpecularVisibilityZero) {
  RandomInput random;
  for (int i = 0; i < 1000; ++i) {
    const vec3 bent = random.facing(kNormal), reflection = random.facing(kNormal);
    EXPECT_NEAR(
        maths::specular_occlusion(0.0f, bent, kNormal, reflection, random.uniform(0.01f, 1.0f)),
        0.0f, 1e-5f);
  }
}

TEST(Gtso, MirrorReflectionIsUnoccludedExactlyInsideTheVisibilityCone) {
  const vec3 inside(0.3f, 0, std::sqrt(1 - 0.09f)), outside(0.9f, 0, std::sqrt(1 - 0.81f));
  EXPECT_EQ(maths::specular_occlusion(0.5f, kNormal, kNormal, inside, 0.0f), 1.0f);
  EXPECT_EQ(maths::specular_occlusion(0.5f, kNormal, kNormal, outside, 0.0f), 0.0f);
}

TEST(Gtso, SpecularVisibilityIncreasesWithVisibilityAndIsAtMostOne) {
  RandomInput random;
  for (int i = 0; i < 500; ++i) {
    const vec3 bent = random.facing(kNormal), reflection = random.facing(kNormal);
    const float alpha = random.uniform(0.0f, 1.0f);
    float before = 0.0f;
    for (float v = 0.0f; v <= 1.0f; v += 0.02f) {
      const float s = maths::specular_occlusion(v, bent, kNormal, reflection, alpha);
      EXPECT_GE(s, before - 1e-3f);
      EXPECT_LE(s, 1.0f);
      before = s;
    }
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
