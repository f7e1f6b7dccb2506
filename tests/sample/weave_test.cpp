#include "evaluate/weave.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace alcove::sample {
namespace {

constexpr std::uint32_t kSize = 256;

Image<float> image_of(const std::function<float(std::uint32_t x, std::uint32_t y)>& value) {
  Image<float> image(kSize, kSize);
  for (std::uint32_t y = 0; y < kSize; ++y) {
    for (std::uint32_t x = 0; x < kSize; ++x) {
      image.at(x, y) = value(x, y);
    }
  }
  return image;
}

const Image<float>& smooth_truth() {
  static const Image<float> truth =
      image_of([](std::uint32_t x, std::uint32_t y) { return 0.3f + 0.001f * x + 0.0005f * y; });
  return truth;
}

const Mask kEverywhere(kSize, kSize, 1);

Weave weave_of_error(const std::function<float(std::uint32_t x, std::uint32_t y)>& error) {
  return weave_of(image_of([&](std::uint32_t x, std::uint32_t y) {
                    return smooth_truth().at(x, y) + error(x, y);
                  }),
                  smooth_truth(), kEverywhere);
}

// Alternating +a and -a on diagonals: a herringbone pattern with an RMS of a.
float diagonal(std::uint32_t x, std::uint32_t y, float amplitude) {
  return ((x + y) % 4 < 2) ? amplitude : -amplitude;
}

TEST(WeavePattern, ErrorPatternWithAPeriodOfFourPixelsIsMeasuredByItsRms) {
  const Weave weave =
      weave_of_error([](std::uint32_t x, std::uint32_t y) { return diagonal(x, y, 0.004f); });
  EXPECT_EQ(weave.windows, kSize * kSize / (32u * 32u));
  // The measured RMS is larger than 0.004 by sqrt(16/15), because the sample variance of the 16
  // averages divides by 15. The tolerance allows for the mean over 9x9 pixels, which contains some
  // of the pattern.
  EXPECT_NEAR(weave.rms(), 0.004 * std::sqrt(16.0 / 15.0), 0.0002);
  EXPECT_EQ(weave.visible_windows, 0u);
}

TEST(WeavePattern, ImageWindowsWithAVisiblePatternAreCounted) {
  const Weave weave = weave_of_error([](std::uint32_t x, std::uint32_t y) {
    return x < kSize / 4 ? diagonal(x, y, 0.008f) : 0.0f;
  });
  EXPECT_NEAR(weave.visible_fraction(), 0.25, 1e-9);
}

TEST(WeavePattern, WhiteNoiseIsNotMeasuredAsAPattern) {
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0.0f, 0.03f);
  const Weave weave = weave_of_error([&](std::uint32_t, std::uint32_t) { return noise(random); });
  // Without the subtraction of white noise the RMS would be 0.03 / 8.
  EXPECT_LT(weave.rms(), 0.0012);
  EXPECT_EQ(weave.visible_windows, 0u);
}

TEST(WeavePattern, PatternWeakerThanTheNoiseIsStillMeasured) {
  std::mt19937 random(11);
  std::normal_distribution<float> noise(0.0f, 0.02f);
  const Weave weave = weave_of_error(
      [&](std::uint32_t x, std::uint32_t y) { return diagonal(x, y, 0.004f) + noise(random); });
  EXPECT_NEAR(weave.rms(), 0.0041, 0.0008);
}

TEST(WeavePattern, SmoothErrorsAndPatternsOfOtherPeriodsAreIgnored) {
  EXPECT_LT(weave_of_error([](std::uint32_t x, std::uint32_t) {
              return 0.05f * std::sin(0.05f * static_cast<float>(x));
            }).rms(),
            1e-4);
  EXPECT_LT(weave_of_error([](std::uint32_t x, std::uint32_t) {
              return x % 3 == 0 ? 0.004f : -0.002f;
            }).rms(),
            4e-4);
}

TEST(WeavePattern, ImageWindowsWithSkyOrWithDetailInTheTruthAreNotCounted) {
  Mask surfaces = kEverywhere;
  surfaces.at(40, 40) = 0;  // in one window
  Image<float> truth = smooth_truth();
  for (std::uint32_t y = 0; y < 32; ++y) {
    for (std::uint32_t x = 0; x < 10; ++x) {
      truth.at(x, y) *= 0.5f;  // a crease in another
    }
  }
  EXPECT_EQ(weave_of(truth, truth, surfaces).windows, kSize * kSize / (32u * 32u) - 2);
}

TEST(WeavePattern, ImageSmallerThanAMeasuringWindowHasNoWindows) {
  const Image<float> small(31, 31, 0.5f);
  const Weave weave = weave_of(small, small, Mask(31, 31, 1));
  EXPECT_EQ(weave.windows, 0u);
  EXPECT_EQ(weave.rms(), 0.0);
  EXPECT_EQ(weave.visible_fraction(), 0.0);
}

TEST(WeavePattern, PixelThatIsNaNDoesNotMakeTheMeasuredPatternNaN) {
  Image<float> result = smooth_truth();
  result.at(5, 5) = NAN;
  EXPECT_TRUE(std::isfinite(weave_of(result, smooth_truth(), kEverywhere).rms()));
}

}  // namespace
}  // namespace alcove::sample
