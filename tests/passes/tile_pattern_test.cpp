// Tests that the tiles, of each of which one pixel is traced in a frame, do not show in the
// filtered picture of the first frames of a history.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "drawing.h"

namespace alcove::passes {
namespace {

constexpr std::uint32_t kWidth = 384, kHeight = 256;

// Returns the means of value(x, y) over the pixels at each position in blocks of `period` x
// `period` pixels.
template <typename Value>
std::vector<double> means_by_position(std::uint32_t period, const Value& value) {
  std::vector<double> means(std::size_t{period} * period);
  for (std::uint32_t y = 0; y < kHeight; ++y)
    for (std::uint32_t x = 0; x < kWidth; ++x)
      means[y % period * period + x % period] +=
          value(x, y) * static_cast<double>(means.size()) / (kWidth * kHeight);
  return means;
}

class TilePattern : public PassTest {};

TEST_F(TilePattern, TilesDoNotShowInTheFirstFramesOfAHistory) {
  struct {
    AlcoveQuality quality;
    double step;                    // RMS between neighbours, at the worst column of the tiles
    std::array<double, 4> pattern;  // RMS of the means over 2x2 tiles in frames 0 to 3
  } constexpr kLimits[] = {         // 1.3 times the values of a run
                           {ALCOVE_QUALITY_CONSOLE, 0.0155, {0.0017, 0.0026, 0.0026, 0.0038}},
                           {ALCOVE_QUALITY_LOW, 0.028, {0.0007, 0.0026, 0.0027, 0.0041}},
                           {ALCOVE_QUALITY_MEDIUM, 0.0225, {0.0006, 0.0014, 0.0018, 0.002}},
                           {ALCOVE_QUALITY_HIGH, 0.014, {0.0004, 0.0004, 0.0005, 0.0009}}};
  // A corner of three walls is occluded differently along every slice.
  const glm::dvec3 corner(0.3, -0.2, -5.0);
  Scene walls;
  for (const double angle : {0.3, 2.4, 4.5})
    walls.push_back(plane(corner, {std::cos(angle), std::sin(angle), 0.7}));
  const Drawing drawing = draw(test_views()[2], kWidth, kHeight, walls);
  OcclusionSettings untiled(ALCOVE_QUALITY_MEDIUM, 2.0f);
  untiled.tile_size = 1;
  untiled.slices = 16;
  const HostImage smooth = render(drawing, untiled).visibility;
  for (const auto& limit : kLimits) {
    const OcclusionSettings settings(limit.quality, 2.0f);
    for (std::uint32_t index = 0; index < limit.pattern.size(); ++index) {
      SCOPED_TRACE(testing::Message() << "quality " << limit.quality << ", frame " << index);
      const HostImage image = render(drawing, settings, index).visibility;
      const auto means = means_by_position(2 * settings.tile_size, [&](auto x, auto y) {
        return double{image.at(x, y)} - smooth.at(x, y);
      });
      double mean = 0.0, square = 0.0;
      for (const double value : means) mean += value / static_cast<double>(means.size());
      for (const double value : means)
        square += std::pow(value - mean, 2.0) / static_cast<double>(means.size());
      EXPECT_LT(std::sqrt(square), limit.pattern[index]);
      const auto squared_steps = means_by_position(settings.tile_size, [&](auto x, auto y) {
        return std::pow(double{image.at(x, y)} - image.at(std::max(x, 1u) - 1, y), 2.0);
      });
      EXPECT_LT(std::sqrt(std::ranges::max(squared_steps)), limit.step);
    }
  }
}

}  // namespace
}  // namespace alcove::passes
