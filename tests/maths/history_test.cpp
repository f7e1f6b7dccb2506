// Tests the texels of the history and the accumulation of frames.
#include <gtest/gtest.h>

#include <cmath>

#include "maths/history.h"
#include "random_input.h"

namespace alcove::maths_test {
namespace {

maths::HistoryTexel texel_of(float depth, float occlusion, float recent, float weight) {
  maths::HistoryTexel texel;
  texel.depth = depth;
  texel.occlusion = occlusion;
  texel.recent = recent;
  texel.weight = weight;
  return texel;
}

// Rounds to the nearest value that a 16-bit UNORM channel can hold.
float unorm16(float value) { return std::round(value * 65535.0f) / 65535.0f; }

maths::HistoryTexel stored(const maths::HistoryTexel& texel, float dither) {
  const maths::vec2 stored = maths::pack_history_texel(texel, dither);
  return maths::unpack_history_texel({unorm16(stored.x), unorm16(stored.y)});
}

constexpr float kMaxWeight = float(maths::kMaxHistoryFrames);

// The root of a weight in steps of its five bits.
float weight_code(float weight) { return 31.0f * std::sqrt(weight / kMaxWeight); }

TEST(History, PackedHistoryTexelKeepsItsValuesWithinTheirQuantisationSteps) {
  RandomInput random;
  for (int i = 0; i < 20000; ++i) {
    const glm::vec4 numbers{random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1),
                            random.uniform(0, kMaxWeight)};
    const maths::HistoryTexel texel = texel_of(numbers.x, numbers.y, numbers.z, numbers.w);
    const maths::HistoryTexel back = stored(texel, random.uniform(0.0f, 0.999f));
    EXPECT_NEAR(back.depth, texel.depth, 7.5f / 65535.0f);
    EXPECT_NEAR(back.occlusion, texel.occlusion, 1.0f / 2047.0f + 4e-6f);
    EXPECT_NEAR(std::sqrt(back.recent), std::sqrt(texel.recent), 1.0f / 6.0f + 1e-3f);
    EXPECT_NEAR(weight_code(back.weight), weight_code(texel.weight), 1.0f + 1e-4f);
  }
}

TEST(History, PackedHistoryTexelKeepsZeroAndTheLargestValuesExactlyAtAnyDither) {
  for (const float dither : {0.0f, 0.3f, 0.9999f}) {
    const maths::HistoryTexel least = stored(texel_of(0, 0, 0, 0), dither);
    EXPECT_NEAR(least.depth, 0.0f, 4.2f / 65535.0f);  // which also holds the recent occlusion
    EXPECT_EQ(least.occlusion, 0.0f);
    EXPECT_NEAR(least.recent, 0.0f, 1e-15f);  // processors contract a*b+c
    EXPECT_EQ(least.weight, 0.0f);
    const maths::HistoryTexel most = stored(texel_of(1, 1, 1, kMaxWeight), dither);
    EXPECT_FLOAT_EQ(most.depth, 1.0f);
    EXPECT_NEAR(most.occlusion, 1.0f, 4e-6f);
    EXPECT_NEAR(most.recent, 1.0f, 1e-3f);
    EXPECT_FLOAT_EQ(most.weight, kMaxWeight);
    EXPECT_FLOAT_EQ(stored(texel_of(1, 1, 1, 1000), dither).weight, kMaxWeight);
    const maths::HistoryTexel none = stored(texel_of(0.5f, 0.25f, maths::kNoRecent, 1), dither);
    EXPECT_EQ(none.recent, none.occlusion);
  }
}

// The mean of the weight is up to a quarter of a squared step of its root too large, which is 0.033
// frames.
TEST(History, DitheredPackingKeepsTheMeanOfOcclusionAndWeight) {
  constexpr int kSteps = 1000;
  for (const float value : {0.0004f, 0.1234f, 0.5f, 0.9871f}) {
    for (const float weight : {0.3f, 2.0f, 17.0f, 100.0f}) {
      double occlusion = 0.0;
      double mean_weight = 0.0;
      for (int i = 0; i < kSteps; ++i) {
        const float dither = (static_cast<float>(i) + 0.5f) / kSteps;
        const maths::HistoryTexel back = stored(texel_of(0.5f, value, 0.0f, weight), dither);
        occlusion += back.occlusion / kSteps;
        mean_weight += back.weight / kSteps;
      }
      EXPECT_NEAR(occlusion, value, 5e-6);
      EXPECT_NEAR(mean_weight, weight, 0.034 + 0.003 * weight);
    }
  }
}

TEST(History, BitFieldAtAnyPositionOfAWordIsUnpackedToZeroToOne) {
  for (unsigned bits = 1; bits <= 16; ++bits) {
    for (unsigned first = 0; first + bits <= 32; ++first) {
      const unsigned last = (1u << bits) - 1u;
      const unsigned others = ~(last << first);
      EXPECT_EQ(maths::unpack_mantissa(others, first, bits), 0.0f);
      EXPECT_FLOAT_EQ(maths::unpack_mantissa(~others, first, bits), 1.0f);
      const unsigned value = last / 3u;
      EXPECT_NEAR(maths::unpack_mantissa(others | (value << first), first, bits),
                  float(value) / float(last), 1e-6f);
    }
  }
}

TEST(History, PackedSpecularTexelKeepsItsValuesWithinQuantisationSteps) {
  RandomInput random;
  for (int i = 0; i < 20000; ++i) {
    maths::LobeTexel texel;
    texel.occlusion = random.uniform(0, 1);
    texel.open = std::exp2(random.uniform(-11.0f, 3.9f));
    const maths::LobeTexel back =
        maths::unpack_lobe_texel(maths::pack_lobe_texel(texel, random.uniform(0.0f, 0.999f)));
    EXPECT_NEAR(back.occlusion, texel.occlusion, 1.0f / 511.0f + 2e-6f);
    EXPECT_NEAR(std::log2(back.open), std::log2(texel.open), 0.3f);
  }
  maths::LobeTexel none;
  none.occlusion = 0.0f;
  none.open = 0.0f;
  const maths::LobeTexel back = maths::unpack_lobe_texel(maths::pack_lobe_texel(none, 0.9f));
  EXPECT_EQ(back.occlusion, 0.0f);
  EXPECT_EQ(back.open, 0.0f);
}

TEST(History, HistoryTexelsWithAnotherDepthThanThePixelAreRejected) {
  const maths::vec4 near = maths::history_agreement({0.0f, -0.1f, 0.6f, -1.1f}, 0.1f);
  EXPECT_EQ(near.x, 1.0f);
  EXPECT_EQ(near.y, 1.0f) << "rounding of a stored depth";
  EXPECT_NEAR(near.z, 0.25f, 1e-5f);
  EXPECT_NEAR(near.w, 0.0f, 1e-12f);
  EXPECT_EQ(maths::history_agreement(maths::vec4(-1e30f), 0.1f).x, 0.0f);
}

TEST(History, HistoryWeightFallsByTheVarianceThatInterpolationAddsToTheNoise) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const float weight = random.uniform(1.0f, 127.0f);
    const float variance = random.uniform(0.0f, 0.25f);
    const float missing = random.uniform(0.0f, 1.0f);
    // The variance of the accumulated visibility before and after its weight is reduced.
    const float before = maths::kFrameVariance / weight;
    const float after = maths::kFrameVariance / maths::weight_after_blur(weight, variance, missing);
    EXPECT_NEAR(after, before + variance + maths::kMissingVariance * missing, 1e-5f * after);
  }
  EXPECT_EQ(maths::weight_after_blur(32.0f, 0.0f, 0.0f), 32.0f);
  EXPECT_EQ(maths::weight_after_blur(0.0f, 0.2f, 1.0f), 0.0f);
}

TEST(History, LargeVisibilityChangesAreRecognisedAndSmallOnesAreTakenForNoise) {
  RandomInput random;
  for (int i = 0; i < 2000; ++i) {
    const float a = random.uniform(0.0f, 1.0f);
    const float b = random.uniform(0.0f, 1.0f);
    EXPECT_EQ(maths::visibility_changed(a, a), 0.0f);
    const float change = maths::visibility_changed(a, b);
    EXPECT_GE(change, 0.0f);
    EXPECT_LE(change, 1.0f);
    EXPECT_EQ(change, maths::visibility_changed(b, a));
  }
  // Unoccluded surfaces have no noise, so that outdated occlusion would leave a visible trail. A
  // change to or from full visibility must be recognised at once.
  EXPECT_EQ(maths::visibility_changed(0.8f, 1.0f), 1.0f);
  EXPECT_EQ(maths::visibility_changed(1.0f, 0.8f), 1.0f);
  EXPECT_EQ(maths::visibility_changed(0.55f, 0.45f), 0.0f);
  EXPECT_EQ(maths::visibility_changed(0.2f, 0.8f), 1.0f);
}

TEST(History, RecentOcclusionIsAMeanOverOnlyAFewFrames) {
  EXPECT_EQ(maths::update_recent(0.3f, 0.0f, 0.9f, 1.0f), 0.9f);
  EXPECT_FLOAT_EQ(maths::update_recent(0.2f, 1.0f, 0.4f, 1.0f), 0.3f);
  const auto after_a_dozen = [](float open) {
    float recent = 0.0f;
    for (int frame = 0; frame < 12; ++frame)
      recent = maths::update_recent(recent, 32.0f, 1.0f, open);
    return recent;
  };
  EXPECT_GT(after_a_dozen(1.0f), 0.95f);
  // Samples with a small weight for the pixel's surface change the mean little. If there is no
  // history, the mean becomes this frame's value.
  EXPECT_LT(after_a_dozen(0.02f), 0.35f);
  EXPECT_EQ(maths::update_recent(0.3f, 0.0f, 0.9f, 0.0f), 0.9f);
}

}  // namespace
}  // namespace alcove::maths_test
