#include "maths/multi_bounce.h"

#include <gtest/gtest.h>

#include <limits>

namespace alcove::maths_test {
namespace {

TEST(MultiBounce, VisibilityZeroAndOneAreUnchangedAtAnyAlbedo) {
  for (float albedo = 0.0f; albedo <= 1.0f; albedo += 0.01f) {
    EXPECT_EQ(maths::multi_bounce_channel(1.0f, albedo), 1.0f);
    EXPECT_EQ(maths::multi_bounce_channel(0.0f, albedo), 0.0f);
  }
}

TEST(MultiBounce, ResultIsAtLeastTheVisibilityAndIncreasesWithVisibilityAndAlbedo) {
  for (float albedo = 0.0f; albedo <= 1.0f; albedo += 0.02f) {
    float before = 0.0f;
    for (float v = 0.0f; v <= 1.0f; v += 0.005f) {
      const float bounced = maths::multi_bounce_channel(v, albedo);
      EXPECT_GE(bounced, v);
      EXPECT_LE(bounced, 1.0f);
      EXPECT_GE(bounced, before - 1e-6f);
      EXPECT_GE(maths::multi_bounce_channel(v, albedo + 0.02f), bounced - 1e-3f);
      before = bounced;
    }
  }
}

TEST(MultiBounce, ResultEqualsTheCubicPolynomialOfThePaper) {
  // Section 5 at visibility 0.5 and albedo 0.5: a = 0.6878, b = -1.75585, c = 2.0679.
  EXPECT_NEAR(maths::multi_bounce_channel(0.5f, 0.5f),
              ((0.5 * 0.6878 - 1.75585) * 0.5 + 2.0679) * 0.5, 1e-6);
}

TEST(MultiBounce, NaNVisibilityGivesZeroAndNaNAlbedoCountsAsAlbedoZero) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(maths::multi_bounce_channel(none, 0.5f), 0.0f);
  EXPECT_EQ(maths::multi_bounce_channel(0.4f, none), maths::multi_bounce_channel(0.4f, 0.0f));
}

TEST(MultiBounce, ColourChannelsAreComputedIndependently) {
  const glm::vec3 bounced = maths::multi_bounce(0.4f, glm::vec3(0.9f, 0.5f, 0.1f));
  EXPECT_EQ(bounced.x, maths::multi_bounce_channel(0.4f, 0.9f));
  EXPECT_EQ(bounced.y, maths::multi_bounce_channel(0.4f, 0.5f));
  EXPECT_EQ(bounced.z, maths::multi_bounce_channel(0.4f, 0.1f));
}

TEST(MultiBounce, VisibilityAndAlbedoOutOfRangeAreClamped) {
  EXPECT_EQ(maths::multi_bounce_channel(2.0f, 0.5f), 1.0f);
  EXPECT_EQ(maths::multi_bounce_channel(-1.0f, 0.5f), 0.0f);
  EXPECT_EQ(maths::multi_bounce_channel(0.5f, 9.0f), maths::multi_bounce_channel(0.5f, 1.0f));
}

}  // namespace
}  // namespace alcove::maths_test
