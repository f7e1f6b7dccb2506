// Tests that frames with static noise do not depend on the number of the frame.
#include <gtest/gtest.h>

#include "gtao_scenes.h"
#include "pass_fixture.h"

namespace alcove::passes {
namespace {

class StaticNoise : public PassTest {
 protected:
  HostOutputs images(std::uint32_t index, const OcclusionSettings& settings) {
    return render(drawing_, settings, index);
  }

 private:
  Drawing drawing_ = draw(test_views()[2], 70, 45, ball_on_floor());
};

TEST_F(StaticNoise, FramesWithoutHistoryAreIdentical) {
  for (const AlcoveQuality quality : {ALCOVE_QUALITY_CONSOLE, ALCOVE_QUALITY_HIGH}) {
    SCOPED_TRACE(static_cast<int>(quality));
    OcclusionSettings settings = all_outputs(quality, 0.6f);
    settings.history_frames = 0;
    settings.static_noise = 1;
    const HostOutputs first = images(0, settings);
    for (const std::uint32_t index : {1u, 2u, 7u, 0xffffffffu}) {
      SCOPED_TRACE(index);
      expect_equal(images(index, settings), first);
    }
    settings.static_noise = 0;
    EXPECT_NE(images(2, settings).visibility.texels, images(3, settings).visibility.texels);
  }
}

TEST_F(StaticNoise, HasNoEffectWithAHistory) {
  OcclusionSettings settings = all_outputs(ALCOVE_QUALITY_LOW, 0.6f);
  HostImage last[2];
  for (const bool static_noise : {false, true}) {
    settings.static_noise = static_noise;
    for (std::uint32_t index = 0; index < 4; ++index)
      last[static_noise ? 1 : 0] = images(index, settings).visibility;
  }
  EXPECT_EQ(last[0].texels, last[1].texels);
}

}  // namespace
}  // namespace alcove::passes
