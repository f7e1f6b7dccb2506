// What history is kept, and how frames add up.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "maths/history.h"
#include "maths/projection.h"
#include "random_input.h"

namespace alcove::maths_test {
namespace {

maths::HistoryTexel texel_of(float visibility, float open, float depth, float count, float recent,
                             unsigned quantised_normal) {
  maths::HistoryTexel texel;
  texel.visibility = visibility;
  texel.open = open;
  texel.depth = depth;
  texel.count = count;
  texel.recent = recent;
  texel.quantised_normal = quantised_normal;
  return texel;
}

maths::HistoryTexel stored(const maths::HistoryTexel& texel) {
  return maths::unpack_history_texel(maths::pack_history_texel(texel));
}

maths::HistoryTexel held_as(float depth) {
  return stored(texel_of(1.0f, 0.0f, depth, 0.0f, 0.0f, 0u));
}

TEST(History, DepthThatDiffersIsRejectedAndSlantedDepthGivenRoom) {
  EXPECT_EQ(maths::history_weight(0.0f, 0.02f, 1.0f), 1.0f);
  EXPECT_EQ(maths::history_weight(0.03f, 0.02f, 1.0f), 0.0f);
  EXPECT_GT(maths::history_weight(0.03f, 0.02f, 0.2f), 0.5f);
  const float sky = maths::held_apart(10.0f, maths::kSkyDepth);
  EXPECT_EQ(maths::history_weight(sky, 0.02f, 0.0f), 0.0f);
  EXPECT_EQ(maths::history_weight(maths::held_apart(0.0f, 0.0f), 0.02f, 0.0f), 1.0f);
}

TEST(History, NormalsThatDifferAreRejected) {
  const auto weight = [](float angle) { return maths::history_weight_by_normal(angle * angle); };
  EXPECT_EQ(weight(0.0f), 1.0f);
  EXPECT_GE(weight(0.2f), 0.9f);
  EXPECT_EQ(weight(0.65f), 0.0f);
  EXPECT_EQ(weight(3.0f), 0.0f);
}

TEST(History, WhatAHalfRoundsAwayIsNoDistance) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const float depth = std::exp(random.uniform(-7.0f, 11.0f));
    const float held = held_as(depth).depth;
    EXPECT_EQ(maths::held_apart(depth, held), 0.0f);
    EXPECT_NEAR(maths::held_apart(depth, 1.01f * depth), 0.01f, 6e-4f);
  }
}

TEST(History, EqualFramesWeighTheSameUntilTheLongest) {
  RandomInput random;
  float history = 0.0f, count = 0.0f;
  double sum = 0.0;
  for (int frame = 1; frame <= 32; ++frame) {
    const float now = random.uniform(0, 1);
    sum += now;
    history = glm::mix(history, now, maths::accumulation_weight(count, 64.0f));
    count = maths::next_count(count, 64.0f);
    EXPECT_NEAR(history, sum / frame, 1e-5);
  }
}

TEST(History, NeverDriftsOrLocksOverAMillionFrames) {
  float history = 0.0f, count = 0.0f;
  for (int frame = 0; frame < 1000000; ++frame) {
    history = glm::mix(history, 0.7f, maths::accumulation_weight(count, 32.0f));
    count = maths::next_count(count, 32.0f);
  }
  EXPECT_NEAR(history, 0.7f, 1e-6f);
  EXPECT_EQ(count, 32.0f);
  for (int frame = 0; frame < 400; ++frame)
    history = glm::mix(history, 0.2f, maths::accumulation_weight(count, 32.0f));
  EXPECT_NEAR(history, 0.2f, 1e-5f);
}

TEST(History, FirstFrameStandsAlone) { EXPECT_EQ(maths::accumulation_weight(0.0f, 32.0f), 1.0f); }

TEST(History, SpreadIsMeanAndDeviation) {
  const maths::Spread s = maths::spread_of_sums(1.0f + 2.0f + 3.0f, 1.0f + 4.0f + 9.0f, 3.0f);
  EXPECT_FLOAT_EQ(s.mean, 2.0f);
  EXPECT_NEAR(s.deviation, std::sqrt(2.0f / 3.0f), 1e-6f);
  EXPECT_EQ(maths::spread_of_sums(0.0f, 0.0f, 0.0f).deviation, 0.0f);
  EXPECT_GE(maths::spread_of_sums(9 * 0.1f, 9 * 0.01f - 1e-6f, 9.0f).deviation, 0.0f);
}

TEST(History, ClampKeepsWhatAgreesAndCountForgetsWhatMoved) {
  maths::Spread now;
  now.mean = 0.5f;
  now.deviation = 0.1f;
  EXPECT_EQ(maths::clamp_to_spread(0.55f, now, 1.0f), 0.55f);
  EXPECT_FLOAT_EQ(maths::clamp_to_spread(0.9f, now, 1.0f), 0.6f);
  EXPECT_EQ(maths::count_after_clamp(20.0f, 0.55f, 0.55f, 0.2f), 20.0f);
  EXPECT_EQ(maths::count_after_clamp(20.0f, 0.9f, 0.6f, 0.2f), 1.0f);
  EXPECT_FLOAT_EQ(maths::count_after_clamp(21.0f, 0.7f, 0.6f, 0.2f), 11.0f);
}

TEST(History, WhatIsBlurredCountsAsNoiseOfItsVariance) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const float count = random.uniform(1.0f, 255.0f);
    const float variance = random.uniform(0.0f, 0.25f);
    const float missing = random.uniform(0.0f, 1.0f);
    // The variance of a mean of so many frames, before and after.
    const float before = maths::kFrameVariance / count;
    const float after = maths::kFrameVariance / maths::count_after_blur(count, variance, missing);
    EXPECT_NEAR(after, before + variance + maths::kUnobservedVariance * missing, 1e-5f * after);
  }
  EXPECT_EQ(maths::count_after_blur(32.0f, 0.0f, 0.0f), 32.0f);
  EXPECT_EQ(maths::count_after_blur(0.0f, 0.2f, 1.0f), 0.0f);
}

TEST(History, ATexelKeepsWhatItHolds) {
  RandomInput random;
  for (int i = 0; i < 20000; ++i) {
    const float open = random.uniform(1e-3f, maths::kLargestOpen);
    const float visibility = i % 5 == 0 ? 1.0f : random.uniform(0.0f, 1.0f);
    const float depth = std::exp(random.uniform(-7.0f, 11.0f));
    const float count = std::floor(random.uniform(0.0f, maths::kMaxHistoryFrames + 0.99f));
    const float recent = random.uniform(0.0f, 1.0f);
    const auto normal = static_cast<unsigned>(i % 256);
    const maths::HistoryTexel texel =
        stored(texel_of(visibility, open, depth, count, recent, normal));
    EXPECT_NEAR(texel.open, open, open / 120);
    EXPECT_NEAR(texel.visibility, visibility, 1e-5f);
    if (visibility == 1.0f) {
      EXPECT_EQ(texel.visibility, 1.0f);
    }
    EXPECT_NEAR(texel.depth, depth, depth * std::ldexp(1.0f, -11));
    EXPECT_EQ(texel.count, count);
    EXPECT_NEAR(texel.recent, recent, 0.5f / 127.0f + 1e-6f);
    EXPECT_EQ(texel.quantised_normal, normal);
  }
}

TEST(History, ATexelHoldsTheNearestOfWhatItCannot) {
  const maths::HistoryTexel least = stored(texel_of(-1.0f, -1.0f, -1.0f, -1.0f, -1.0f, 0u));
  EXPECT_EQ(least.count + least.recent + least.depth + least.visibility + least.open, 0.0f);
  EXPECT_EQ(least.quantised_normal, 0u);
  const maths::HistoryTexel most = stored(texel_of(9.0f, 8.0f, 6e4f, 300.0f, 2.0f, 255u));
  EXPECT_EQ(most.count, float(maths::kMaxHistoryFrames));
  EXPECT_EQ(most.recent, 1.0f);
  EXPECT_EQ(most.open, maths::kLargestOpen);
  EXPECT_EQ(most.visibility, 1.0f);
  EXPECT_EQ(most.quantised_normal, 255u);
}

TEST(History, DepthOfAnyUnitIsHeldAlike) {
  for (const int exponent : {-40, 0, 40}) {
    // As a near plane at 0.125 units, brought to 2^-14.
    const glm::vec2 scale(std::ldexp(1.0f, -11 - exponent), 0.0f);
    for (const float depth : {0.125f, 1.0f, 4.7f, 1e6f}) {
      const float held = maths::held_depth(scale, std::ldexp(depth, exponent));
      EXPECT_EQ(held, std::ldexp(depth, -11));
      EXPECT_NEAR(held_as(held).depth, held, held * std::ldexp(1.0f, -11));
    }
    EXPECT_EQ(maths::held_depth(scale, 1e30f), 6e4f);
  }
}

TEST(History, ChangeIsToldFromTheNoiseOfAFewSearches) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const float a = random.uniform(0.0f, 1.0f);
    const float b = random.uniform(0.0f, 1.0f);
    EXPECT_EQ(maths::visibility_changed(a, a), 0.0f);
    const float changed = maths::visibility_changed(a, b);
    EXPECT_GE(changed, 0.0f);
    EXPECT_LE(changed, 1.0f);
    EXPECT_EQ(changed, maths::visibility_changed(b, a));
  }
  // There is no noise in the open, where a trail is seen at once.
  EXPECT_EQ(maths::visibility_changed(0.8f, 1.0f), 1.0f);
  EXPECT_EQ(maths::visibility_changed(1.0f, 0.8f), 1.0f);
  EXPECT_EQ(maths::visibility_changed(0.55f, 0.45f), 0.0f);
  EXPECT_EQ(maths::visibility_changed(0.2f, 0.8f), 1.0f);
}

TEST(History, RecentIsAMeanThatForgetsInAFewFrames) {
  EXPECT_EQ(maths::recent_visibility(0.3f, 0.0f, 0.9f, 1.0f), 0.9f);
  EXPECT_FLOAT_EQ(maths::recent_visibility(0.2f, 1.0f, 0.4f, 1.0f), 0.3f);
  const auto after_a_dozen = [](float open) {
    float recent = 0.0f;
    for (int frame = 0; frame < 12; ++frame) {
      recent = maths::recent_visibility(recent, 32.0f, 1.0f, open);
    }
    return recent;
  };
  EXPECT_GT(after_a_dozen(1.0f), 0.95f);
  // What hardly any search of the pixel's own surface says changes little; a first frame is taken.
  EXPECT_LT(after_a_dozen(0.02f), 0.35f);
  EXPECT_EQ(maths::recent_visibility(0.3f, 0.0f, 0.9f, 0.0f), 0.9f);
}

}  // namespace
}  // namespace alcove::maths_test
