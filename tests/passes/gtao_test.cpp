#include <gtest/gtest.h>

#include <algorithm>

#include "alcove/passes/setting_table.h"
#include "drawing.h"

namespace alcove::passes {
namespace {

constexpr float kLeast = 1.0f - 1.0f / 255.0f;

class GtaoPass : public PassTest {
 protected:
  // Returns the smallest visibility of frame `index`.
  float lowest(const Drawing& drawing, const OcclusionSettings& settings, std::uint32_t index = 0) {
    return std::ranges::min(render(drawing, settings, index).visibility.texels);
  }
};

OcclusionSettings precise(AlcoveQuality quality) {
  OcclusionSettings settings(quality, 0.5f);
  settings.precision = ALCOVE_PRECISION_FLOAT32;
  return settings;
}

TEST_F(GtaoPass, UnoccludedPlaneHasVisibilityOneAtAnyTilt) {
  for (const TestView& view : test_views()) {
    for (const double degrees : {0.0, 30.0, 60.0, 75.0, 85.0}) {
      const Drawing drawing = draw(view, 96, 64, {tilted_plane(degrees, 4.0)});
      for (const AlcoveQuality quality :
           {ALCOVE_QUALITY_CONSOLE, ALCOVE_QUALITY_LOW, ALCOVE_QUALITY_MEDIUM, ALCOVE_QUALITY_HIGH,
            ALCOVE_QUALITY_REFERENCE}) {
        SCOPED_TRACE(testing::Message() << view.name << " tilted " << degrees << " degrees, "
                                        << kQualityNames.at(quality));
        const std::uint32_t frames = quality == ALCOVE_QUALITY_REFERENCE ? 1 : 4;
        for (std::uint32_t index = 0; index < frames; ++index)
          EXPECT_GE(lowest(drawing, precise(quality), index), kLeast) << "in frame " << index;
      }
    }
  }
}

}  // namespace
}  // namespace alcove::passes
