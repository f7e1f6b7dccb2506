#include "maths/gtso_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "gtso_table.h"
#include "maths/gtso.h"
#include "random_input.h"

namespace alcove::maths_test {
namespace {

using alcove::passes::GtsoLobe;
using alcove::passes::look_up_gtso;

const std::vector<std::uint32_t>& table() {
  static const std::vector<std::uint32_t> entries = alcove::passes::gtso_table();
  return entries;
}

float look_up(float visibility, float bent_from_mirror, float mirror_from_normal, float roughness) {
  return look_up_gtso(table(), visibility, maths::visibility_cone(visibility), bent_from_mirror,
                      mirror_from_normal, roughness);
}

// Returns an angle between bent normal and mirror direction at which the cone can lie above the
// surface.
float possible_angle(float share, float cone, float mirror_from_normal) {
  const float room = maths::kHalfPi - cone;
  const float low = std::max(mirror_from_normal - room, 0.0f);
  const float high = std::min(mirror_from_normal + room, maths::kPi);
  return low + share * (high - low);
}

// Compares the table with the integral at random coordinates. Some coordinates are at the ends of
// their ranges, so that entries, edges and points between entries are all tested.
TEST(GtsoTable, LookedUpSpecularOcclusionIsCloseToItsIntegral) {
  RandomInput random(1);  // a fixed set, because the README states its figures
  double squares = 0.0, worst = 0.0;
  int count = 0;
  const auto coordinate = [&](int i) {
    const float x = random.uniform(0.0f, 1.0f);
    return i % 7 == 0 ? std::round(x) : x;
  };
  for (int i = 0; i < 400; ++i) {
    const float mirror_from_normal = coordinate(i) * 1.55f;  // at most 89 degrees
    const float roughness = std::max(coordinate(i + 3), 0.04f);
    const GtsoLobe lobe(mirror_from_normal, roughness, 4096);
    for (int j = 0; j < 20; ++j) {
      const float visibility = coordinate(j + 1);
      const float cone = maths::visibility_cone(visibility);
      const float angle = possible_angle(coordinate(j + 4), cone, mirror_from_normal);
      const double truth = lobe.share(cone, angle, 32);
      const double error = look_up(visibility, angle, mirror_from_normal, roughness) - truth;
      squares += error * error;
      worst = std::max(worst, std::abs(error));
      ++count;
    }
  }
  const double rmse = std::sqrt(squares / count);
  std::cout << "specular occlusion table: max " << worst << ", RMSE " << rmse << "\n";
  // For a narrow lobe at the edge of the cone, the fraction falls from 1 to 0 within one entry.
  EXPECT_LT(worst, 0.3);
  EXPECT_LT(rmse, 0.008);
}

TEST(GtsoTable, SpecularOcclusionOfFullyOpenFullyOccludedAndMirrorSurfacesIsExact) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const float mirror_from_normal = random.uniform(0.0f, maths::kHalfPi);
    const float roughness = random.uniform(0.0f, 1.0f);
    const float angle = random.uniform(0.0f, maths::kPi);
    EXPECT_EQ(look_up(1.0f, angle, mirror_from_normal, roughness), 1.0f);
    EXPECT_EQ(look_up(0.0f, angle, mirror_from_normal, roughness), 0.0f);
    const float visibility = random.uniform(0.01f, 0.99f);
    EXPECT_EQ(look_up(visibility, angle, mirror_from_normal, 0.0f),
              angle <= maths::visibility_cone(visibility) ? 1.0f : 0.0f);
  }
}

// Around the normal, the lobe within a cone is a formula: of the microfacets that the view sees,
// the fraction within half the cone's angle. At roughness 0 the cosines of these cones differ by
// millionths.
TEST(GtsoTable, FractionOfTheNarrowestLobeWithinNarrowConesIsThatOfTheFormula) {
  const GtsoLobe lobe(0.0f, 0.0f, 4096);
  for (const float width : {0.3f, 0.5f, 1.0f, 1.5f, 2.0f, 4.0f, 16.0f}) {
    const float cone = width * maths::kSmallestAlpha;
    const float squared = 0.25f * width * width;
    EXPECT_NEAR(lobe.share(cone, 0.0f, 1), squared / (1.0f + squared), 2e-3f) << width;
  }
}

// At roughness 1 only the last layer of the table is read. At the coordinates of an entry the value
// is exact to 8 bits.
TEST(GtsoTable, TableEntriesAtRoughnessOneEqualTheIntegralTo8Bits) {
  for (const unsigned mirror : {0u, 7u, 14u}) {
    const float mirror_from_normal =
        maths::unsqueeze_mirror(float(mirror) / float(maths::kGtsoMirror - 1));
    const GtsoLobe lobe(mirror_from_normal, 1.0f, 1024);
    for (unsigned y = 1; y + 1 < maths::kGtsoCone; ++y) {
      const float cone =
          maths::unsqueeze_cone(float(y) / float(maths::kGtsoCone - 1), maths::gtso_width(1.0f));
      const float visibility = std::sin(cone) * std::sin(cone);
      for (unsigned x = 0; x < maths::kGtsoInside; ++x) {
        const float squeezed = float(x) / float(maths::kGtsoInside - 1) * 2.0f - 1.0f;
        const float angle = cone - maths::unsqueeze_inside(squeezed, cone, maths::gtso_width(1.0f));
        EXPECT_NEAR(look_up(visibility, angle, mirror_from_normal, 1.0f),
                    lobe.share(cone, angle, 8), 0.01f)
            << mirror << " " << y << " " << x;
      }
    }
  }
}

TEST(GtsoTable, TableCoordinatesConvertToAnglesAndBack) {
  RandomInput random;
  for (int i = 0; i < 5000; ++i) {
    const float cone = random.uniform(0.01f, maths::kHalfPi);
    const float width = maths::gtso_width(random.uniform(0.05f, 1.0f));
    const float inside = random.uniform(cone - maths::kPi, cone);
    const float squeezed = maths::squeeze_inside(inside, cone, width);
    EXPECT_LE(std::abs(squeezed), 1.00001f);
    EXPECT_NEAR(maths::unsqueeze_inside(squeezed, cone, width), inside, 2e-3f);
    EXPECT_NEAR(maths::unsqueeze_cone(maths::squeeze_cone(cone, width), width), cone, 2e-3f);
    EXPECT_NEAR(maths::unsqueeze_mirror(maths::squeeze_mirror(cone)), cone, 1e-5f);
  }
}

// Bent normals are at random azimuths around the mirror direction, of which the table has the mean.
TEST(GtsoTable, ErrorOfTheTableIsSmallAtAnyAzimuthOfTheBentNormal) {
  RandomInput random;
  double squares = 0.0;
  for (int i = 0; i < 600; ++i) {
    const float mirror_from_normal = random.uniform(0.0f, 1.5f);
    const float roughness = random.uniform(0.1f, 1.0f);
    const GtsoLobe lobe(mirror_from_normal, roughness, 1024);
    const float visibility = random.uniform(0.05f, 0.95f);
    const glm::vec3 normal(0, 0, 1);
    const glm::vec3 mirror(std::sin(mirror_from_normal), 0.0f, std::cos(mirror_from_normal));
    const glm::vec3 bent = maths::raised_bent_normal(random.facing(normal), normal, visibility);
    const double truth = lobe.within(maths::visibility_cone(visibility), bent);
    squares += std::pow(
        look_up(visibility, maths::angle_between(bent, mirror), mirror_from_normal, roughness) -
            truth,
        2);
  }
  EXPECT_LT(std::sqrt(squares / 600), 0.03);
}

}  // namespace
}  // namespace alcove::maths_test
