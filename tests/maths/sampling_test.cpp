#include "maths/sampling.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <set>
#include <vector>

namespace alcove::maths_test {
namespace {

using glm::uvec2;
using maths::SliceNoise;

// Returns the length of the longest interval of [0,1) that contains none of the values. 0 and 1
// count as the same point.
float largest_gap(std::vector<float> values) {
  std::sort(values.begin(), values.end());
  float gap = values.front() + 1.0f - values.back();
  for (std::size_t k = 1; k < values.size(); ++k) gap = std::max(gap, values[k] - values[k - 1]);
  return gap;
}

TEST(GoldenPattern, BlocksOfFourByFourPixelsCoverSliceDirectionsAndStepOffsetsEvenly) {
  for (unsigned frame : {0u, 1u, 5u, 1000000u}) {
    for (const uvec2 corner : {uvec2(0, 0), uvec2(4, 16), uvec2(1920, 1080)}) {
      std::vector<float> directions, offsets;
      for (unsigned k = 0; k < 16; ++k) {
        const SliceNoise noise =
            maths::golden_pattern(corner + uvec2(k & 3u, k >> 2u), frame, frame > 1u);
        directions.push_back(
            maths::golden_pattern(corner + uvec2(k & 3u, k >> 2u), frame, false).direction);
        offsets.push_back(noise.offset);
        EXPECT_TRUE(noise.direction >= 0.0f && noise.direction < 1.0f);
        EXPECT_TRUE(noise.offset >= 0.0f && noise.offset < 1.0f);
      }
      EXPECT_LT(largest_gap(directions), 3.3f / 16);
      EXPECT_LT(largest_gap(offsets), 2.7f / 16);
    }
  }
}

TEST(GoldenPattern, AnyTwoByTwoTilesHaveOneDirectionInEachQuarterOfTheRange) {
  for (const unsigned frame : {0u, 1u, 7u, 1000000u}) {
    for (const uvec2 corner : {uvec2(0, 0), uvec2(3, 16), uvec2(8, 5), uvec2(481, 271)}) {
      std::array<int, 4> counts{};
      for (unsigned k = 0; k < 4; ++k) {
        const uvec2 tile = corner + uvec2(k & 1u, k >> 1u);
        const float direction = maths::golden_pattern(tile, frame, true).direction;
        // Without the rotation by the frame, which is the same for all tiles.
        const unsigned bits = unsigned(direction * 0x1p24f) * 256u - frame * 1737350766u + 128u;
        ++counts.at(bits >> 30u);
      }
      EXPECT_THAT(counts, testing::Each(1)) << frame << ", " << corner.x << ", " << corner.y;
    }
  }
}

// Directions within their quarter and offsets of tiles that are `period` apart must differ. Each
// value is mapped to a point of the unit circle. The mean of these points is near the centre if the
// values vary, and on the circle if all of them are equal.
TEST(GoldenPattern, PatternDoesNotRepeatOverTheImageWithAnySmallPeriod) {
  constexpr unsigned kWindow = 96;
  for (const unsigned period : {1u, 2u, 3u, 4u, 8u}) {
    for (unsigned place = 0; place < period * period; ++place) {
      std::complex<double> directions, offsets;
      for (unsigned y = place / period; y < kWindow; y += period) {
        for (unsigned x = place % period; x < kWindow; x += period) {
          const SliceNoise noise = maths::golden_pattern(uvec2(x, y), 7, true);
          directions += std::polar(1.0, 2.0 * std::numbers::pi * 4.0 * noise.direction);
          offsets += std::polar(1.0, 2.0 * std::numbers::pi * noise.offset);
        }
      }
      const double count = double(kWindow * kWindow) / (period * period);
      EXPECT_LT(std::abs(directions) / count, 0.2) << "period " << period;
      EXPECT_LT(std::abs(offsets) / count, 0.2) << "period " << period;
    }
  }
}

// The error of a pixel depends on the direction of its slice. If the directions were a lattice over
// the image, each harmonic of this dependence would be visible as waves: its spectrum over the
// image would have one peak of 1. A pixel with history has one trace, or eight after 32 frames.
// Waves with a period of exactly two tiles are left out, because the filter averages 2x2 tiles.
TEST(GoldenPattern, SliceDirectionsFormNoWavesOverTheImage) {
  constexpr unsigned kWindow = 48;
  using Complex = std::complex<double>;
  const auto wave = [](double turns) { return std::polar(1.0, 2.0 * std::numbers::pi * turns); };
  const auto mean_of_traces = [&](unsigned harmonic, unsigned traces, unsigned x, unsigned y) {
    Complex mean;
    for (unsigned k = 0; k < traces; ++k) {
      const double direction = maths::golden_pattern(uvec2(x, y), 4 * k, true).direction;
      mean += wave(harmonic * direction) / double(traces);
    }
    return mean;
  };
  for (const unsigned traces : {1u, 8u}) {
    for (const unsigned harmonic : {1u, 2u, 3u, 5u, 8u}) {
      std::vector<Complex> rows(std::size_t{kWindow} * kWindow);
      for (unsigned y = 0; y < kWindow; ++y) {
        for (unsigned x = 0; x < kWindow; ++x) {
          const Complex value = mean_of_traces(harmonic, traces, x, y);
          for (unsigned u = 0; u < kWindow; ++u)
            rows[std::size_t{y} * kWindow + u] += value * wave(-double(u * x) / kWindow);
        }
      }
      for (unsigned v = 0; v < kWindow; ++v) {
        for (unsigned u = 0; u < kWindow; ++u) {
          Complex sum;
          for (unsigned y = 0; y < kWindow; ++y)
            sum += rows[std::size_t{y} * kWindow + u] * wave(-double(v * y) / kWindow);
          const bool two_tiles = u % (kWindow / 2) == 0 && v % (kWindow / 2) == 0 && u + v > 0;
          EXPECT_LT(two_tiles ? 0.0 : std::abs(sum) / (kWindow * kWindow), 0.3)
              << traces << " traces, harmonic " << harmonic << ", " << u << " and " << v
              << " waves in the window";
        }
      }
    }
  }
}

TEST(GoldenPattern, ConsecutiveFramesOfAPixelCoverSliceDirectionsAndStepOffsetsEvenly) {
  for (unsigned start : {0u, 123u, 4000000000u}) {
    std::vector<float> directions, offsets;
    for (unsigned frame = 0; frame < 32; ++frame) {
      const SliceNoise noise = maths::golden_pattern(uvec2(2, 1), start + frame, false);
      directions.push_back(noise.direction);
      offsets.push_back(noise.offset);
    }
    EXPECT_LT(largest_gap(directions), 2.7f / 32);
    EXPECT_LT(largest_gap(offsets), 4.2f / 32);
  }
}

TEST(GoldenPattern, EveryFourthFrameOfAPixelCoversSliceDirectionsAndStepOffsetsEvenly) {
  for (unsigned start : {0u, 123u, 4000000000u}) {
    for (const unsigned apart : {1u, 4u}) {
      std::vector<float> directions, offsets;
      for (unsigned k = 0; k < 32; ++k) {
        const SliceNoise noise = maths::golden_pattern(uvec2(2, 1), start + apart * k, true);
        directions.push_back(noise.direction);
        offsets.push_back(noise.offset);
      }
      EXPECT_LT(largest_gap(directions), 2.7f / 32) << apart;
      EXPECT_LT(largest_gap(offsets), 4.2f / 32) << apart;
    }
  }
}

TEST(Slices, SliceAnglesAreEvenlySpacedOver180Degrees) {
  EXPECT_FLOAT_EQ(maths::slice_angle(0, 3, 0.0f), 0.0f);
  EXPECT_FLOAT_EQ(maths::slice_angle(2, 4, 0.0f), maths::kHalfPi);
  EXPECT_LT(maths::slice_angle(2, 3, 0.99f), maths::kPi);
}

}  // namespace
}  // namespace alcove::maths_test
