#include "maths/bent_normal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "maths/gtao.h"
#include "maths/raw_occlusion.h"
#include "random_input.h"
#include "slice_truth.h"

namespace alcove::maths_test {
namespace {

using glm::vec3;
using maths::Slice;

TEST(BentNormal, BentNormalIntegralOfAHalfSliceAgreesWithQuadratureForEveryNormalAndHorizon) {
  double worst = 0.0;
  for_each_slice_and_horizon([&](const Slice& s, const SliceTruth& truth, float c) {
    const glm::dvec2 ahead = truth.bent(0.0, std::acos(double(c)));
    const glm::dvec2 behind = truth.bent(-std::acos(double(c)), 0.0);
    worst = std::max(worst, distance(glm::dvec2(maths::bent_arc(s, 1.0f, c)), ahead));
    worst = std::max(worst, distance(glm::dvec2(maths::bent_arc(s, -1.0f, c)), behind));
  });
  EXPECT_LT(worst, 1e-6);
}

TEST(BentNormal, BentNormalOfASliceEqualsTheFormulaOfThePaper) {
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

struct DirectedSlice {
  Slice slice;
  vec3 direction;
};

DirectedSlice make_slice_at(float phi, const vec3& normal, const vec3& view) {
  const vec3 direction = maths::slice_direction(maths::make_view_basis(view), phi);
  return {maths::make_slice(normal, direction, view), direction};
}

std::vector<float> even_angles(int count) {
  std::vector<float> angles(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k)
    angles[static_cast<std::size_t>(k)] = float(kPi * (k + 0.5) / count);
  return angles;
}

TEST(BentNormal, BentNormalOfAnUnoccludedSurfaceIsItsNormalEvenFromASingleSlice) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const vec3 view = random.facing(vec3(0, 0, 1)), normal = random.facing(view);
    const auto [s, direction] = make_slice_at(random.uniform(0.0f, float(kPi)), normal, view);
    const float open = maths::open_slice(s);
    const vec3 part = maths::slice_bent_normal(s, direction, view, -1.0f, -1.0f);
    const vec3 residual =
        maths::converged_residual(maths::residual_of(part, open, normal),
                                  maths::expected_residual(s, direction, view, normal, open), 1.0f);
    if (open > 1e-2f) {
      EXPECT_LT(distance(maths::finish_bent_normal(residual, open, normal), normal), 1e-4f);
    }
  }
}

TEST(BentNormal, BentNormalResidualsOfAnUnoccludedSurfaceSumToZeroOverAllSlices) {
  RandomInput random;
  for (int i = 0; i < 200; ++i) {
    const vec3 view = random.facing(vec3(0, 0, 1)), normal = random.facing(view);
    vec3 sum(0);
    float largest = 0.0f;
    for (const float phi : even_angles(512)) {
      const auto [s, direction] = make_slice_at(phi, normal, view);
      const vec3 residual =
          maths::expected_residual(s, direction, view, normal, maths::open_slice(s));
      largest =
          std::max({largest, std::abs(residual.x), std::abs(residual.y), std::abs(residual.z)});
      sum += residual;
    }
    EXPECT_LT(length(sum) / 512.0f, 1e-4f);
    EXPECT_LT(largest, maths::kLargestResidual);
  }
}

// A wall in a random direction occludes a part of one half of each slice. Compares the bent normal
// of 3 slices at random angles, which weight directions unevenly, with that of 256 evenly spaced
// slices. Over 2,000 walls, the root-mean-square difference must be smaller if the expected
// residual is subtracted.
TEST(BentNormal, SubtractingTheExpectedResidualReducesTheBentNormalErrorOfThreeSlices) {
  RandomInput random;
  double raw = 0.0;
  double corrected = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const vec3 view = random.facing(vec3(0, 0, 1)), normal = random.facing(view);
    const vec3 wall =
        maths::slice_direction(maths::make_view_basis(view), random.uniform(0.0f, 6.28f));
    const float height = random.uniform(0.0f, 3.0f);
    const auto bent_normal_over = [&](const std::vector<float>& angles, bool subtract_expected) {
      vec3 residual(0), expected_residual(0);
      float visible = 0.0f, open = 0.0f;
      for (const float phi : angles) {
        const auto [s, direction] = make_slice_at(phi, normal, view);
        // The cosine of the horizon of a wall at unit distance.
        const float toward = dot(direction, wall);
        const float rise = height * std::abs(toward);
        const float horizon = rise / std::sqrt(1.0f + rise * rise);
        const float ahead = toward > 0.0f ? horizon : -1.0f;
        const float behind = toward > 0.0f ? -1.0f : horizon;
        const vec3 part = maths::slice_bent_normal(s, direction, view, ahead, behind);
        const float visible_part = slice_visibility(s, ahead, behind);
        const float all = maths::open_slice(s);
        visible += visible_part;
        open += all;
        residual += maths::residual_of(part, visible_part, normal);
        expected_residual += maths::expected_residual(s, direction, view, normal, all);
      }
      const vec3 sum = subtract_expected
                           ? maths::converged_residual(residual, expected_residual, visible / open)
                           : residual;
      return maths::finish_bent_normal(sum, visible, normal);
    };
    const vec3 truth = bent_normal_over(even_angles(256), false);
    const std::vector<float> few{random.uniform(0.0f, float(kPi)), random.uniform(0.0f, float(kPi)),
                                 random.uniform(0.0f, float(kPi))};
    const vec3 raw_apart = bent_normal_over(few, false) - truth;
    const vec3 corrected_apart = bent_normal_over(few, true) - truth;
    raw += double(dot(raw_apart, raw_apart));
    corrected += double(dot(corrected_apart, corrected_apart));
  }
  EXPECT_LT(std::sqrt(corrected), 0.75 * std::sqrt(raw));
}

TEST(BentNormal, BentNormalBesideAWallPointsAwayFromTheWall) {
  const vec3 view(0, 0, 1);
  const Slice s = maths::make_slice(view, vec3(1, 0, 0), view);
  const vec3 bent = maths::slice_bent_normal(s, vec3(1, 0, 0), view, 0.8f, -1.0f);
  EXPECT_LT(bent.x, -0.1f);
  EXPECT_GT(bent.z, 0.1f);
}

TEST(BentNormal, BentNormalOfAFullyOccludedSurfaceIsItsNormal) {
  const vec3 normal(0, 1, 0);
  EXPECT_EQ(maths::finish_bent_normal(vec3(0), 0.0f, normal), normal);
  EXPECT_EQ(maths::finish_bent_normal(vec3(1e-30f), 0.0f, normal), normal);
  const Slice s = maths::make_slice(vec3(0, 0, 1), vec3(1, 0, 0), vec3(0, 0, 1));
  EXPECT_EQ(maths::slice_bent_normal(s, vec3(1, 0, 0), vec3(0, 0, 1), 1.0f, 1.0f), vec3(0));
}

}  // namespace
}  // namespace alcove::maths_test
