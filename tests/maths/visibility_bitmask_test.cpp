#include "maths/visibility_bitmask.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "random_input.h"
#include "slice_truth.h"

namespace alcove::maths_test {
namespace {

using glm::vec3;
using maths::SectorScale;
using maths::Slice;

using Interval = std::pair<double, double>;

float position_of(const Slice& s, const SectorScale& scale, double angle) {
  return maths::sector_position(s, scale, angle < 0 ? -1.0f : 1.0f, float(std::cos(angle)));
}

// Visibility of a slice outside the union of some intervals of angle.
double visibility_outside(const SliceTruth& truth, std::vector<Interval> hidden) {
  std::sort(hidden.begin(), hidden.end());
  double visible = 0.0, reached = truth.lowest();
  for (const auto& [from, to] : hidden) {
    if (from > reached) visible += truth.visibility(reached, from);
    reached = std::max(reached, to);
  }
  return visible + truth.visibility(reached, truth.highest());
}

TEST(VisibilityBitmask, PositionIsTheDistributionOfTheSlice) {
  for (double gamma = -1.55; gamma <= 1.55; gamma += 0.05) {
    const Slice s = slice_of(0.9, gamma);
    const SectorScale scale = maths::make_sector_scale(s);
    const SliceTruth truth(s);
    for (double angle = truth.lowest(); angle <= truth.highest(); angle += 0.02) {
      const double expected = truth.visibility(truth.lowest(), angle) / truth.open();
      EXPECT_NEAR(position_of(s, scale, angle), expected, 2e-4) << gamma << " " << angle;
    }
  }
}

TEST(VisibilityBitmask, PositionRunsFromZeroToOneAtTheTangentPlane) {
  for (double gamma = -kPi / 2; gamma <= kPi / 2; gamma += 0.01) {
    const Slice s = slice_of(0.9, gamma);
    const SectorScale scale = maths::make_sector_scale(s);
    EXPECT_NEAR(maths::sector_position(s, scale, -1.0f, -1.0f), 0.0f, 1e-6f);
    EXPECT_NEAR(maths::sector_position(s, scale, 1.0f, -1.0f), 1.0f, 1e-6f);
    EXPECT_NEAR(maths::sector_position(s, scale, 1.0f, 1.0f),
                maths::sector_position(s, scale, -1.0f, 1.0f), 1e-6f);
  }
}

TEST(VisibilityBitmask, CoversWhatItIsTold) {
  EXPECT_EQ(maths::cover_sectors(0.0f, 1.0f, 0.5f), 0xffffffffu);
  EXPECT_EQ(maths::cover_sectors(1.0f, 0.0f, 0.5f), 0xffffffffu);
  EXPECT_EQ(maths::cover_sectors(0.0f, 0.25f, 0.5f), 0xffu);
  EXPECT_EQ(maths::cover_sectors(0.5f, 0.75f, 0.5f), 0x00ff0000u);
  EXPECT_EQ(maths::cover_sectors(0.4f, 0.4f, 0.5f), 0u);
  EXPECT_EQ(maths::cover_sectors(1.0f, 1.0f, 0.999f), 0u);
  EXPECT_EQ(maths::cover_sectors(0.0f, 7.0f, 0.0f), 0xffffffffu);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(maths::cover_sectors(nan, 1.0f, 0.5f), 0u);
  EXPECT_EQ(maths::cover_sectors(0.0f, nan, 0.5f), 0u);
}

TEST(VisibilityBitmask, CountsSectorsWithinHalfAnEdgeEach) {
  RandomInput random;
  for (int i = 0; i < 20000; ++i) {
    const float from = random.uniform(0, 1), to = random.uniform(0, 1);
    const int bits = std::popcount(maths::cover_sectors(from, to, 0.5f));
    EXPECT_NEAR(bits, 32.0f * std::abs(to - from), 1.0f + 1e-4f);
  }
}

TEST(VisibilityBitmask, DitheredRangesAreUnbiasedHoweverThin) {
  for (const float width : {1e-3f, 0.01f, 0.02f, 0.1f}) {
    for (const float from : {0.0f, 0.013f, 0.41f, 0.8f}) {
      double sum = 0.0;
      constexpr int kDithers = 4096;
      for (int k = 0; k < kDithers; ++k)
        sum +=
            std::popcount(maths::cover_sectors(from, from + width, (float(k) + 0.5f) / kDithers));
      EXPECT_NEAR(sum / kDithers, 32.0 * width, 1e-3);
    }
  }
}

TEST(VisibilityBitmask, AgreesWithTheUnionOfIntervalsWithinItsSectors) {
  RandomInput random;
  double squares = 0.0;
  constexpr int kCases = 4000;
  for (int i = 0; i < kCases; ++i) {
    const Slice s = slice_of(random.uniform(0.05f, 1.0f), random.uniform(-1.57f, 1.57f));
    const SectorScale scale = maths::make_sector_scale(s);
    const SliceTruth truth(s);
    std::vector<Interval> hidden;
    unsigned occluded = 0;
    const int count = 1 + int(random.bits() % 5);
    for (int k = 0; k < count; ++k) {
      double from = random.uniform(float(truth.lowest()), float(truth.highest()));
      double to = random.uniform(float(truth.lowest()), float(truth.highest()));
      if (from > to) std::swap(from, to);
      hidden.emplace_back(from, to);
      occluded |=
          maths::cover_sectors(position_of(s, scale, from), position_of(s, scale, to), 0.5f);
    }
    // Each of at most 2 * count edges is off by at most half a sector.
    const double error = maths::bitmask_visibility(scale, occluded) / truth.open() -
                         visibility_outside(truth, hidden) / truth.open();
    EXPECT_LE(std::abs(error), count / 32.0 + 1e-3);
    squares += error * error;
  }
  EXPECT_LT(std::sqrt(squares / kCases), 0.02);
}

TEST(VisibilityBitmask, OpenAndFullAreExact) {
  for (double gamma = -kPi / 2; gamma <= kPi / 2; gamma += 0.1) {
    const Slice s = slice_of(0.7, gamma);
    const SectorScale scale = maths::make_sector_scale(s);
    EXPECT_EQ(maths::bitmask_visibility(scale, 0u), scale.open);
    EXPECT_EQ(maths::bitmask_visibility(scale, 0xffffffffu), 0.0f);
    EXPECT_NEAR(scale.open, maths::open_slice(s), 2e-4f);
  }
}

TEST(VisibilityBitmask, SliceThatHoldsNothingStaysFinite) {
  const Slice s = maths::make_slice(vec3(0, 1, 0), vec3(1, 0, 0), vec3(0, 0, 1));
  const SectorScale scale = maths::make_sector_scale(s);
  EXPECT_EQ(maths::bitmask_visibility(scale, 0u), 0.0f);
  EXPECT_TRUE(std::isfinite(maths::sector_position(s, scale, 1.0f, 0.3f)));
}

TEST(VisibilityBitmask, InfinitelyThickSamplesGiveTheHorizon) {
  RandomInput random;
  const vec3 view(0, 0, 1);
  for (int i = 0; i < 2000; ++i) {
    const Slice s = slice_of(1.0, random.uniform(-1.4f, 1.4f));
    const SectorScale scale = maths::make_sector_scale(s);
    const vec3 delta(random.uniform(0.1f, 1.0f), 0, random.uniform(-0.2f, 1.0f));
    const unsigned mask = maths::sample_sectors(s, scale, 1.0f, delta, view, view, 1e9f, 0.5f);
    const float expected = maths::slice_visibility(s, maths::horizon_cosine(delta, view), -1.0f);
    EXPECT_NEAR(maths::bitmask_visibility(scale, mask), expected, scale.open * (0.51f / 32));
  }
}

TEST(VisibilityBitmask, ThickerOccludersCoverMore) {
  RandomInput random;
  const vec3 view(0, 0, 1);
  for (int i = 0; i < 2000; ++i) {
    const Slice s = slice_of(1.0, random.uniform(-1.4f, 1.4f));
    const SectorScale scale = maths::make_sector_scale(s);
    const float side = random.bits() % 2 == 0 ? 1.0f : -1.0f;
    const vec3 delta(side * random.uniform(0.01f, 1.0f), 0, random.uniform(-1.0f, 1.0f));
    unsigned before = 0u;
    for (const float thickness : {0.0f, 0.01f, 0.1f, 1.0f, 10.0f}) {
      const unsigned mask =
          maths::sample_sectors(s, scale, side, delta, view, view, thickness, 0.5f);
      EXPECT_EQ(mask & before, before);
      before = mask;
    }
  }
}

TEST(VisibilityBitmask, ThicknessIsTheSumOfItsModels) {
  maths::Thickness t;
  t.constant = 0.5f;
  t.per_radius = 0.2f;
  t.per_depth = 0.01f;
  EXPECT_FLOAT_EQ(maths::occluder_thickness(t, 2.0f, 10.0f), 1.0f);
  EXPECT_FLOAT_EQ(maths::occluder_thickness(t, 2.0f, -10.0f), 0.9f);
}

}  // namespace
}  // namespace alcove::maths_test
