#include "maths/bitmask_bent_normal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "random_input.h"
#include "slice_truth.h"

namespace alcove::maths_test {
namespace {

using maths::SectorScale;
using maths::Slice;

TEST(BitmaskBentNormal, HorizonOfAnArcIsItsInverse) {
  double worst = 0.0;
  for (double gamma = -1.57; gamma <= 1.57; gamma += 0.05) {
    const Slice s = slice_of(1.0, gamma);
    for (const float side : {-1.0f, 1.0f}) {
      const float whole = maths::slice_arc(s, side, -1.0f);
      for (float part = 0.0f; part <= 1.0f; part += 1.0f / 64) {
        const float c = maths::horizon_of_arc(s, side, part * whole);
        worst = std::max(worst, std::abs(double(maths::slice_arc(s, side, c)) - part * whole));
      }
    }
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_LT(worst, 2e-4);
}

TEST(BitmaskBentNormal, AgreesWithTheIntegralOverTheVisibleSectors) {
  RandomInput random;
  double worst = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const Slice s = slice_of(random.uniform(0.1f, 1.0f), random.uniform(-1.57f, 1.57f));
    const SectorScale scale = maths::make_sector_scale(s);
    unsigned occluded = 0u;
    for (unsigned k = random.bits() % 4; k > 0; --k)
      occluded |= maths::cover_sectors(random.uniform(0, 1), random.uniform(0, 1), 0.5f);
    // Sector by sector, each edge found by bisection in double.
    const SliceTruth truth(s);
    const auto angle_at = [&](double part) {
      double low = truth.lowest(), high = truth.highest();
      for (int step = 0; step < 30; ++step) {
        const double middle = 0.5 * (low + high);
        (truth.visibility(truth.lowest(), middle) < part * truth.open() ? low : high) = middle;
      }
      return 0.5 * (low + high);
    };
    glm::dvec2 expected(0.0);
    for (unsigned k = 0; k < 32;) {
      unsigned end = k;
      while (end < 32 && (occluded >> end & 1u) == 0u) ++end;
      if (end > k) expected += truth.bent(angle_at(k / 32.0), angle_at(end / 32.0));
      k = end + 1;
    }
    const glm::dvec2 bent(maths::bitmask_bent(s, scale, occluded));
    worst = std::max(worst, distance(bent, expected));
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_LT(worst, 2e-4);
}

TEST(BitmaskBentNormal, OpenMaskGivesTheOpenSlice) {
  for (double gamma = -1.57; gamma <= 1.57; gamma += 0.05) {
    const Slice s = slice_of(0.7, gamma);
    const glm::vec2 bent = maths::bitmask_bent(s, maths::make_sector_scale(s), 0u);
    const glm::vec2 open = maths::bent_arc(s, 1.0f, -1.0f) + maths::bent_arc(s, -1.0f, -1.0f);
    EXPECT_LT(distance(bent, open), 1e-5f);
    EXPECT_EQ(maths::bitmask_bent(s, maths::make_sector_scale(s), 0xffffffffu), glm::vec2(0.0f));
  }
}

TEST(BitmaskBentNormal, SliceThatHoldsNothingStaysFinite) {
  const Slice s = maths::make_slice(glm::vec3(0, 1, 0), glm::vec3(1, 0, 0), glm::vec3(0, 0, 1));
  const glm::vec2 bent = maths::bitmask_bent(s, maths::make_sector_scale(s), 0x0ff0u);
  EXPECT_EQ(bent, glm::vec2(0.0f));
}

}  // namespace
}  // namespace alcove::maths_test
