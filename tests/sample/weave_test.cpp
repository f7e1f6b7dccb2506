#include "evaluate/weave.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <random>

namespace alcove::sample {
namespace {

constexpr std::uint32_t kSize = 256;

Image<float> image_of(const std::function<float(std::uint32_t x, std::uint32_t y)>& value) {
  Image<float> image(kSize, kSize);
  for (std::uint32_t y = 0; y < kSize; ++y)
    for (std::uint32_t x = 0; x < kSize; ++x) image.at(x, y) = value(x, y);
  return image;
}

const Image<float>& smooth_truth() {
  static const Image<float> truth =
      image_of([](std::uint32_t x, std::uint32_t y) { return 0.3f + 0.001f * x + 0.0005f * y; });
  return truth;
}

const Mask kEverywhere(kSize, kSize, 1);

Weave weave_of_error(const std::function<float(std::uint32_t x, std::uint32_t y)>& error) {
  return measure_weave(image_of([&](std::uint32_t x, std::uint32_t y) {
                         return smooth_truth().at(x, y) + error(x, y);
                       }),
                       smooth_truth(), kEverywhere);
}

// The first window begins at 0 and the next ones every 16 pixels.
constexpr std::uint32_t kWindowsOnASide = (kSize - 32) / 16 + 1;

// Alternating +a and -a on diagonals: a herringbone pattern with an RMS of a.
float diagonal(std::uint32_t x, std::uint32_t y, float amplitude) {
  return ((x + y) % 4 < 2) ? amplitude : -amplitude;
}

// A lattice of dots: one pixel of each tile is brighter. Its RMS is a.
float dots(std::uint32_t x, std::uint32_t y, std::uint32_t period, float a) {
  const float share = 1.0f / static_cast<float>(period * period);
  const float dot = x % period == 0 && y % period == 0 ? 1.0f : 0.0f;
  return a * (dot - share) / std::sqrt(share * (1.0f - share));
}

// Plane waves of any direction and period have an RMS of the amplitude divided by the root of 2.
float wave(std::uint32_t x, std::uint32_t y, float cycles_x, float cycles_y) {
  return std::sin(6.2831853f *
                  (cycles_x * static_cast<float>(x) + cycles_y * static_cast<float>(y)));
}

TEST(WeavePattern, DiagonalPatternIsMeasuredByItsRms) {
  const Weave weave =
      weave_of_error([](std::uint32_t x, std::uint32_t y) { return diagonal(x, y, 0.004f); });
  EXPECT_EQ(weave.windows, kWindowsOnASide * kWindowsOnASide);
  EXPECT_NEAR(weave.rms(), 0.004, 0.0002);
  EXPECT_NEAR(weave.period(), 4.0 / std::sqrt(2.0), 0.1);
  EXPECT_EQ(weave.visible_windows, 0u);
}

TEST(WeavePattern, LatticesOfDotsOfAnyPeriodAreMeasuredByTheirRms) {
  for (const std::uint32_t period : {2u, 3u, 4u, 5u, 6u, 7u, 8u}) {
    const Weave weave = weave_of_error(
        [&](std::uint32_t x, std::uint32_t y) { return dots(x, y, period, 0.004f); });
    EXPECT_NEAR(weave.rms(), 0.004, 0.0004) << period;
    EXPECT_EQ(weave.visible_windows, 0u) << period;
  }
}

TEST(WeavePattern, StripesWithPeriodsOfThreeFiveAndEightPixelsAreMeasuredByTheirRms) {
  for (const std::uint32_t period : {3u, 5u, 8u}) {
    const Weave weave = weave_of_error([&](std::uint32_t x, std::uint32_t) {
      return 0.004f * std::sqrt(2.0f) * wave(x, 0, 1.0f / static_cast<float>(period), 0.0f);
    });
    EXPECT_NEAR(weave.rms(), 0.004, 0.0002) << period;
    EXPECT_NEAR(weave.period(), period, 0.5) << period;
  }
}

TEST(WeavePattern, WavesWhosePeriodIsNoWholeNumberOfPixelsAreMeasuredByTheirRms) {
  const Weave weave = weave_of_error([](std::uint32_t x, std::uint32_t y) {
    return 0.004f * std::sqrt(2.0f) * wave(x, y, 0.3774f, 0.2849f);
  });
  EXPECT_NEAR(weave.rms(), 0.004, 0.0002);
}

TEST(WeavePattern, ImageWindowsWithAVisiblePatternAreCounted) {
  const Weave weave = weave_of_error([](std::uint32_t x, std::uint32_t y) {
    return x < kSize / 2 ? diagonal(x, y, 0.008f) : 0.0f;
  });
  // The first seven of 15 columns of windows contain nothing else, and the next one contains it in
  // one half.
  EXPECT_NEAR(weave.visible_fraction(), 8.0 / kWindowsOnASide, 1e-9);
}

TEST(WeavePattern, WhiteNoiseIsNotMeasuredAsAPattern) {
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0.0f, 0.03f);
  const Weave weave = weave_of_error([&](std::uint32_t, std::uint32_t) { return noise(random); });
  EXPECT_LT(weave.rms(), 0.0002);
  EXPECT_EQ(weave.visible_windows, 0u);
}

TEST(WeavePattern, NoiseThatWasFilteredHasNoPattern) {
  std::mt19937 random(13);
  std::normal_distribution<float> noise(0.0f, 0.03f);
  Image<float> white(kSize + 4, kSize + 4);
  for (float& value : white.pixels) value = noise(random);
  const Weave weave = weave_of_error([&](std::uint32_t x, std::uint32_t y) {
    constexpr std::array<float, 5> kBinomial{1 / 16.0f, 4 / 16.0f, 6 / 16.0f, 4 / 16.0f, 1 / 16.0f};
    float sum = 0.0f;
    for (std::uint32_t j = 0; j < 5; ++j)
      for (std::uint32_t i = 0; i < 5; ++i)
        sum += kBinomial[i] * kBinomial[j] * white.at(x + i, y + j);
    return sum;
  });
  EXPECT_LT(weave.rms(), 0.0003);
  EXPECT_EQ(weave.visible_windows, 0u);
}

TEST(WeavePattern, PatternWeakerThanTheNoiseIsStillMeasured) {
  std::mt19937 random(11);
  std::normal_distribution<float> noise(0.0f, 0.02f);
  const Weave weave = weave_of_error(
      [&](std::uint32_t x, std::uint32_t y) { return diagonal(x, y, 0.004f) + noise(random); });
  EXPECT_NEAR(weave.rms(), 0.004, 0.0006);
}

TEST(WeavePattern, EdgeIsNoPattern) {
  const Weave weave = weave_of_error([](std::uint32_t x, std::uint32_t y) {
    return x % 64 == 20 || (2 * y + x) % 128 == 70 ? 0.05f : 0.0f;
  });
  EXPECT_LT(weave.rms(), 0.001);
}

TEST(WeavePattern, SumOfSeveralImagesIsTheMeanOverAllWindows) {
  Weave weave =
      weave_of_error([](std::uint32_t x, std::uint32_t y) { return diagonal(x, y, 0.008f); });
  weave += weave_of_error([](std::uint32_t, std::uint32_t) { return 0.0f; });
  EXPECT_EQ(weave.windows, 2 * kWindowsOnASide * kWindowsOnASide);
  EXPECT_NEAR(weave.rms(), 0.008 / std::sqrt(2.0), 0.0003);
  EXPECT_NEAR(weave.visible_fraction(), 0.5, 1e-9);
}

TEST(WeavePattern, SmoothErrorsAreIgnored) {
  EXPECT_LT(weave_of_error([](std::uint32_t x, std::uint32_t) {
              return 0.05f * std::sin(0.05f * static_cast<float>(x));
            }).rms(),
            2e-4);
}

TEST(WeavePattern, ImageWindowsWithSkyOrWithDetailInTheTruthAreNotCounted) {
  Mask surfaces = kEverywhere;
  surfaces.at(40, 40) = 0;  // in four windows
  Image<float> truth = smooth_truth();
  for (std::uint32_t y = 0; y < 32; ++y)
    for (std::uint32_t x = 0; x < 10; ++x) truth.at(x, y) *= 0.5f;  // a crease in two others
  EXPECT_EQ(measure_weave(truth, truth, surfaces).windows, kWindowsOnASide * kWindowsOnASide - 6);
}

TEST(WeavePattern, ImageSmallerThanAMeasuringWindowHasNoWindows) {
  const Image<float> small(31, 31, 0.5f);
  const Weave weave = measure_weave(small, small, Mask(31, 31, 1));
  EXPECT_EQ(weave.windows, 0u);
  EXPECT_EQ(weave.rms(), 0.0);
  EXPECT_EQ(weave.visible_fraction(), 0.0);
}

TEST(WeavePattern, PixelThatIsNaNDoesNotAffectOtherWindows) {
  Image<float> result = smooth_truth();
  result.at(5, 5) = NAN;
  const Weave weave = measure_weave(result, smooth_truth(), kEverywhere);
  EXPECT_EQ(weave.windows, kWindowsOnASide * kWindowsOnASide - 1);
  EXPECT_LT(weave.rms(), 1e-6);
}

}  // namespace
}  // namespace alcove::sample
