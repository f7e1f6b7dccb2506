#include "maths/visibility_bitmask.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>

#include "random_input.h"
#include "slice_truth.h"

namespace alcove::maths_test {
namespace {

using glm::vec2;
using glm::vec3;
using maths::Slice;
using maths::VisiblePart;

vec2 light_at(double angle) { return {float(std::sin(angle)), float(std::cos(angle))}; }

float random_side(RandomInput& random) { return random.bits() % 2 == 0 ? 1.0f : -1.0f; }

// Returns a random mask of runs of sectors, as occluders cause them.
std::uint32_t random_runs(RandomInput& random) {
  std::uint32_t occluded = 0;
  for (unsigned k = random.bits() % 4; k > 0; --k) {
    const unsigned first = random.bits(), last = random.bits();
    occluded |= maths::sectors_beyond(first) ^ maths::sectors_beyond(last);
  }
  return maths::repeat_last_sector(occluded & 0x7fffffffu);
}

float sectors_per_diamond_angle(const Slice& s, float side) {
  return 31.0f / maths::tangent_diamond_angle(s, side);
}

// Returns the angle of a sector's boundary to the view direction in double precision.
double boundary_angle(float per_diamond_angle, int boundary) {
  const double y = 1.0 - boundary / double(per_diamond_angle);
  return std::atan2(1.0 - std::abs(y), y);
}

VisiblePart part_of(const Slice& s, float side, std::uint32_t occluded, float hidden_occlusion) {
  return maths::visible_part(s, side, sectors_per_diamond_angle(s, side), occluded,
                             hidden_occlusion, true);
}

TEST(VisibilityBitmask, DiamondAngleIncreasesWithTheAngleAndConvertsBackToTheDirection) {
  float before = -1.0f;
  for (double angle = 0.0; angle <= kPi; angle += 0.001) {
    const vec2 light = light_at(angle);
    const float at = maths::diamond_angle(light * 3.0f);
    EXPECT_GT(at, before);
    EXPECT_LT(distance(maths::diamond_angle_light(at), light), 1e-6f);
    before = at;
  }
  EXPECT_EQ(maths::diamond_angle(vec2(0, 1)), 0.0f);
  EXPECT_EQ(maths::diamond_angle(vec2(1, 0)), 1.0f);
  EXPECT_EQ(maths::diamond_angle(vec2(0, -1)), 2.0f);
  EXPECT_TRUE(std::isfinite(maths::diamond_angle(vec2(0, 0))));
}

TEST(VisibilityBitmask, ExclusiveOrOfTheMasksBeyondTwoPositionsSetsTheSectorsBetweenThem) {
  RandomInput random;
  for (int i = 0; i < 5000; ++i) {
    const Slice s = random_slice(random);
    const float side = random_side(random);
    const float tangent = maths::tangent_diamond_angle(s, side);
    const float a = random.uniform(0.0f, 1.2f), b = random.uniform(0.0f, 1.2f);
    const auto position = [&](float share) {
      return maths::biased_position(1.0f / tangent, 1.0f - share * tangent);
    };
    // Positions beyond the tangent plane are clamped to it.
    const auto expected = [](float share) {
      return std::min(std::nearbyint(share * 31.0f), 31.0f);
    };
    if (std::abs(a * 31.0f - std::floor(a * 31.0f) - 0.5f) < 0.02f ||
        std::abs(b * 31.0f - std::floor(b * 31.0f) - 0.5f) < 0.02f || tangent < 0.02f)
      continue;
    std::uint32_t between = 0;
    for (float k = std::min(expected(a), expected(b)); k < std::max(expected(a), expected(b)); ++k)
      between |= 1u << std::uint32_t(k);
    EXPECT_EQ(maths::sectors_beyond(position(a)) ^ maths::sectors_beyond(position(b)), between);
    EXPECT_EQ(position(a) - maths::kPositionBits, std::uint32_t(expected(a)));
  }
}

TEST(VisibilityBitmask, HighestBitOfTheMaskRepeatsTheLastOf31Sectors) {
  EXPECT_EQ(maths::repeat_last_sector(1u << 30), 3u << 30);
  EXPECT_EQ(maths::repeat_last_sector(1u << 29), 1u << 29);
}

// The visible integral of a mask of sectors, summed over sectors in double precision. Behind the
// first occluder, visible sectors count with the factor 1 - hidden_occlusion.
struct Expected {
  double arc = 0.0;
  glm::dvec2 bent{0.0};
};
Expected expected_part(const Slice& s, float side, std::uint32_t occluded,
                       double hidden_occlusion) {
  const SliceTruth truth(s);
  const float per_diamond_angle = sectors_per_diamond_angle(s, side);
  Expected sum;
  bool behind = false;
  for (int k = 0; k < 31; ++k) {
    if ((occluded >> k & 1u) != 0) {
      behind = true;
      continue;
    }
    double from = boundary_angle(per_diamond_angle, k),
           to = boundary_angle(per_diamond_angle, k + 1);
    if (side < 0.0f) std::tie(from, to) = std::pair(-to, -from);
    const double weight = behind ? 1.0 - hidden_occlusion : 1.0;
    sum.arc += weight * truth.visibility(from, to);
    sum.bent += weight * truth.bent(from, to);
  }
  return sum;
}

TEST(VisibilityBitmask, VisibilityAndBentNormalOfAMaskEqualTheIntegralOverItsVisibleSectors) {
  RandomInput random;
  double worst_arc = 0.0, worst_bent = 0.0;
  for (int i = 0; i < 1500; ++i) {
    const Slice s = random_slice(random);
    const float side = random_side(random);
    const std::uint32_t occluded = random_runs(random);
    const float hidden_occlusion = random.uniform(0, 1);
    const VisiblePart part = part_of(s, side, occluded, hidden_occlusion);
    const Expected expected = expected_part(s, side, occluded, hidden_occlusion);
    worst_arc = std::max(worst_arc, std::abs(double(part.arc) - expected.arc));
    worst_bent = std::max(worst_bent, distance(glm::dvec2(part.bent), expected.bent));
  }
  RecordProperty("worst_arc", std::to_string(worst_arc));
  RecordProperty("worst_bent", std::to_string(worst_bent));
  EXPECT_LT(worst_arc, 4e-4);  // 2.4e-5 at each end of a run and at the tangent plane
  EXPECT_LT(worst_bent, 1e-5);
}

TEST(VisibilityBitmask, MaskWithoutOccludedSectorsIsFullyVisibleAndFullyOccludedMaskIsNotVisible) {
  for (double gamma = -kPi / 2; gamma <= kPi / 2; gamma += 0.1) {
    const Slice s = slice_of(0.7, gamma);
    for (const float side : {-1.0f, 1.0f}) {
      const float open = maths::light_arc(s, side, maths::tangent_light(s, side));
      for (const float hidden_occlusion : {0.0f, 0.4f, 1.0f}) {
        EXPECT_EQ(part_of(s, side, 0u, hidden_occlusion).arc, open);
        EXPECT_EQ(part_of(s, side, 0xffffffffu, hidden_occlusion).arc, 0.0f);
      }
    }
  }
}

TEST(VisibilityBitmask, VisibilityEndsAtTheFirstOccludedSectorIfVolumeBehindOccludersIsSolid) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const Slice s = random_slice(random);
    const float side = random_side(random);
    const float per_diamond_angle = sectors_per_diamond_angle(s, side);
    const int first = int(random.bits() % 31);
    const auto horizon = float(std::cos(boundary_angle(per_diamond_angle, first)));
    // Near the view direction, a cosine stored as a float determines the angle only with an error
    // of sqrt(2^-23).
    EXPECT_NEAR(part_of(s, side, maths::repeat_last_sector(1u << first), 1.0f).arc,
                slice_arc(s, side, horizon), 5e-4f);
  }
}

TEST(VisibilityBitmask,
     ShareOfHiddenVolumeTakenAsSolidGrowsWithOccluderWidthAndAveragesToHiddenOcclusion) {
  for (const float hidden_occlusion : {0.1f, 0.35f, 0.5f, 0.9f}) {
    const float exponent = maths::hidden_exponent(hidden_occlusion);
    constexpr int kSteps = 4000;
    double sum = 0.0;
    float last = 0.0f;
    for (int i = 0; i < kSteps; ++i) {
      const float part =
          maths::hidden_occlusion_behind((float(i) + 0.5f) / kSteps, 0.0f, 1.0f, exponent);
      EXPECT_GE(part, last);
      sum += part;
      last = part;
    }
    // The tolerance is the error of the mid-point rule where the integrand rises steeply from 0.
    EXPECT_NEAR(sum / kSteps, hidden_occlusion, 2e-3) << hidden_occlusion;
    EXPECT_EQ(maths::hidden_occlusion_behind(1.0f, 0.0f, 1.0f, exponent), 1.0f);
  }
}

TEST(VisibilityBitmask, HiddenOcclusionSettingZeroOccludesNothingAndOneEverythingBehindOccluders) {
  for (const float front : {0.0f, 1e-4f, 0.5f, 1.0f, 1.0001f}) {
    EXPECT_EQ(maths::hidden_occlusion_behind(front, 0.0f, 1.0f, maths::hidden_exponent(0.0f)),
              0.0f);
    EXPECT_EQ(maths::hidden_occlusion_behind(front, 0.0f, 1.0f, maths::hidden_exponent(1.0f)),
              1.0f);
  }
}

TEST(VisibilityBitmask, NormalPerpendicularToTheSlicePlaneGivesZeroVisibilityAndZeroBentNormal) {
  const Slice s = maths::make_slice(vec3(0, 1, 0), vec3(1, 0, 0), vec3(0, 0, 1));
  for (const float side : {-1.0f, 1.0f}) {
    EXPECT_EQ(part_of(s, side, 0x0ff0u, 0.4f).arc, 0.0f);
    EXPECT_EQ(part_of(s, side, 0x0ff0u, 0.4f).bent, vec2(0.0f));
  }
}

TEST(VisibilityBitmask, VisibleShareIsTheUnoccludedFractionOfTheSectorsBeyondTheFirstOccludedOne) {
  EXPECT_EQ(maths::visible_share_beyond(0u), 0.0f) << "there is no occluder";
  EXPECT_EQ(maths::visible_share_beyond(0xffffffffu), 0.0f) << "everything is occluded";
  EXPECT_FLOAT_EQ(maths::visible_share_beyond(1u), 30.0f / 31.0f);
  EXPECT_FLOAT_EQ(maths::visible_share_beyond(1u << 30u), 0.0f)
      << "only the last sector is occluded";
  EXPECT_FLOAT_EQ(maths::visible_share_beyond(0x80000001u), 30.0f / 31.0f)
      << "the highest bit is not a sector";
  EXPECT_FLOAT_EQ(maths::visible_share_beyond((1u << 27u) | (1u << 29u)), 0.5f);
}

}  // namespace
}  // namespace alcove::maths_test
