// Tests that a history which was turned off for some frames starts without contents.
#include <gtest/gtest.h>

#include "gtao_scenes.h"
#include "pass_fixture.h"

namespace alcove::passes {
namespace {

class HistoryRestart : public PassTest {
 protected:
  // Renders four frames of a groove with `settings`, four frames of a ball on a floor with
  // `meanwhile`, and one more frame of the ball with `settings`. Returns the images of the last
  // frame. If `forgets` is true, the history is reset before the last frame.
  HostOutputs come_back(const OcclusionSettings& settings, const OcclusionSettings& meanwhile,
                        bool forgets) {
    const TestView view = test_views()[2];
    const Drawing before = draw(view, 32, 24, groove(0.8));
    const Drawing now = draw(view, 32, 24, ball_on_floor());
    std::uint32_t index = 0;
    const auto frame = [&](const Drawing& drawing, const OcclusionSettings& with, bool reset) {
      HostView frame_view = make_view(drawing, with);
      frame_view.reset = reset;
      return run_occlusion(frame_view, index++);
    };
    for (int i = 0; i < 4; ++i) (void)frame(before, settings, i == 0);
    for (int i = 0; i < 4; ++i) (void)frame(now, meanwhile, false);
    return frame(now, settings, forgets);
  }

  void expect_a_new_beginning(const OcclusionSettings& settings,
                              const OcclusionSettings& meanwhile) {
    expect_equal(come_back(settings, meanwhile, false), come_back(settings, meanwhile, true));
  }
};

OcclusionSettings with_history(bool bent_normal) {
  OcclusionSettings settings(ALCOVE_QUALITY_MEDIUM, 0.5f);
  settings.bent_normal = bent_normal;
  settings.precision = ALCOVE_PRECISION_FLOAT32;
  return settings;
}

TEST_F(HistoryRestart, HistoryRestartsWhenBentNormalsAreTurnedOnAgain) {
  expect_a_new_beginning(with_history(true), with_history(false));
}

TEST_F(HistoryRestart, HistoryTurnedOffAndOnAgainStartsWithoutOldContents) {
  for (const bool bent_normal : {false, true}) {
    OcclusionSettings without = with_history(bent_normal);
    without.history_frames = 0;
    expect_a_new_beginning(with_history(bent_normal), without);
  }
}

}  // namespace
}  // namespace alcove::passes
