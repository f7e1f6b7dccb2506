// Tests of still images, and of views that are left out of frames once they have converged.
#include <gmock/gmock.h>

#include "c_interface_fixture.h"

namespace alcove::passes {
namespace {

class CStillImage : public CInterface {
 protected:
  static HostView draw_still(std::uint32_t history_frames) {
    HostView view = draw_view(24, 16);
    view.settings = OcclusionSettings(ALCOVE_QUALITY_LOW, 0.4f);
    view.settings.history_frames = history_frames;
    view.settings.precision = ALCOVE_PRECISION_FLOAT32;
    view.motion = {};
    return view;
  }

  // Runs the frames `first` to `last` of still images.
  void run_still(std::span<AlcoveView> views, std::uint32_t first, std::uint32_t last) {
    for (std::uint32_t number = first; number <= last; ++number) {
      for (AlcoveView& view : views) ASSERT_EQ(alcoveSetStillFrame(number, &view), ALCOVE_SUCCESS);
      run_frame(context(), views, number);
    }
    engine().wait();
  }
};

TEST_F(CStillImage, EqualsConvergedFramesThatTheEngineCounts) {
  HostView from = draw_still(32);
  from.settings.bent_normal = true;
  AlcoveView view = create_view(from);
  const std::uint32_t frames = alcoveGetConvergedFrames(view.info.settings);
  ASSERT_EQ(frames, 128u);
  run_still({&view, 1}, 0, frames - 1);
  HostOutputs expected;
  for (std::uint32_t i = 0; i < frames; ++i) {
    from.static_frames = i;
    from.reset = i == 0;
    expected = run_plainly(from, i);
  }
  expect_equal(read_results(view), expected);
}

TEST_F(CStillImage, ViewThatIsLeftOutOfFramesKeepsItsImageAndItsHistory) {
  // Only the second view is given the frames 8 to 11.
  std::array<AlcoveView, 2> views{create_view(draw_still(8)), create_view(draw_still(8))};
  views[1].info.id = 1;
  run_still(views, 0, 7);
  const HostOutputs before = read_results(views[0]);
  run_still(std::span(views).last(1), 8, 11);
  expect_equal(read_results(views[0]), before);

  // The first view continues with its own frame 8, which has the number 12.
  ASSERT_EQ(alcoveSetStillFrame(8, views.data()), ALCOVE_SUCCESS);
  run_frame(context(), std::span(views).first(1), 12);
  AlcoveView other = create_view(draw_still(8));
  other.info.id = 2;
  run_still({&other, 1}, 0, 7);
  ASSERT_EQ(alcoveSetStillFrame(8, &other), ALCOVE_SUCCESS);
  run_frame(context(), {&other, 1}, 12);
  engine().wait();
  expect_equal(read_results(views[0]), read_results(other));
}

TEST_F(CStillImage, FramesUntilConvergence) {
  AlcoveSettings settings = get_settings(ALCOVE_QUALITY_LOW, 0.4f);
  EXPECT_EQ(alcoveGetConvergedFrames(&settings), 128u);
  settings.history_frames = 0;
  EXPECT_EQ(alcoveGetConvergedFrames(&settings), 0u);  // the noise changes for ever
  settings.static_noise = 1;
  EXPECT_EQ(alcoveGetConvergedFrames(&settings), 1u);
}

}  // namespace
}  // namespace alcove::passes
