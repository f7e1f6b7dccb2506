// Tests of still images, and of views that are skipped once they have converged.
#include <gmock/gmock.h>

#include "c_interface_fixture.h"

namespace alcove::passes {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr AlcoveArea kWhole{0, 0, 24, 16};
constexpr AlcoveArea kPart{4, 4, 12, 8};

class CStillImage : public CInterface {
 protected:
  static HostView draw_still(std::uint32_t history_frames) {
    HostView view = draw_view(24, 16);
    view.settings = quality_settings(Quality::low, 0.4f);
    view.settings.history_frames = history_frames;
    view.settings.precision = Precision::float32;
    view.motion = {};
    return view;
  }
  // Returns a view that has converged after its first frame.
  static HostView draw_without_history() {
    HostView view = draw_still(0);
    view.settings.static_noise = true;
    return view;
  }

  // Creates a view with an output that keeps its contents from frame to frame, and that
  // fill_image() can fill.
  AlcoveView create_skipping_view(const HostView& from) {
    AlcoveView view = create_view(from);
    view.skip_converged = VK_TRUE;
    view.visibility = engine().make_image(view.visibility.format, 24, 16,
                                          view.visibility.usage | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    return view;
  }

  AlcoveViewState get_state(const AlcoveView& view) {
    AlcoveViewState state{.struct_size = sizeof state};
    EXPECT_EQ(alcoveGetViewState(&context(), view.id, &state), ALCOVE_SUCCESS);
    return state;
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

TEST_F(CStillImage, EqualsTheConvergedFramesOfTheCppInterface) {
  HostView from = draw_still(32);
  from.settings.bent_normal = true;
  AlcoveView view = create_view(from);
  const std::uint32_t frames = alcoveGetConvergedFrames(view.settings);
  ASSERT_EQ(frames, 128u);
  run_still({&view, 1}, 0, frames - 1);
  Results expected;
  for (std::uint32_t i = 0; i < frames; ++i) {
    from.static_frames = i;
    from.reset = i == 0;
    expected = run_by_cpp(from, i);
  }
  expect_equal(read_results(view), expected);
}

TEST_F(CStillImage, ConvergedViewIsSkippedUntilItChanges) {
  const HostView from = draw_still(8);
  // The second view is never skipped, and is not given the frames that do nothing.
  std::array<AlcoveView, 2> views{create_skipping_view(from), create_view(from)};
  AlcoveView& view = views[0];
  views[1].id = 1;
  for (std::uint32_t number = 0; number < 128; ++number) {
    run_still(views, number, number);
    const AlcoveViewState state = get_state(view);
    ASSERT_EQ(state.frames, number + 1);
    ASSERT_EQ(state.converged_frames, 128u);
    ASSERT_EQ(state.skipped, VK_FALSE) << number;
  }
  EXPECT_THAT(print_plan(context()), HasSubstr("gtao"));
  expect_equal(read_results(views[1]), read_results(view));

  // Other contents show that nothing is written.
  const HostImage mark{24, 16, std::vector<float>(std::size_t{24} * 16, 0.25f)};
  fill_image(view.visibility, mark);
  run_still({&view, 1}, 128, 131);
  EXPECT_EQ(get_state(view).skipped, VK_TRUE);
  EXPECT_THAT(print_plan(context()), Not(HasSubstr("gtao")));
  EXPECT_EQ(read_results(view).visibility.texels, mark.texels);

  // An image without contents is written, and the history has lost nothing.
  view.visibility.initial_state.layout = VK_IMAGE_LAYOUT_UNDEFINED;
  run_still(views, 132, 132);
  EXPECT_EQ(get_state(view).skipped, VK_FALSE);
  expect_equal(read_results(view), read_results(views[1]));
  view.visibility.initial_state = kResting;

  // So does a camera that moves again.
  for (AlcoveView& moved : views) {
    moved.static_frames = 0;
    moved.camera.view_from_world[12] += 0.05f;
  }
  run_frame(context(), views, 133);
  engine().wait();
  EXPECT_EQ(get_state(view).frames, 1u);
  expect_equal(read_results(view), read_results(views[1]));
}

TEST_F(CStillImage, ChangeOfAConvergedViewIsRecordedAgain) {
  AlcoveView view = create_skipping_view(draw_without_history());
  ASSERT_EQ(alcoveGetConvergedFrames(view.settings), 1u);
  std::uint32_t index = 0;
  const auto is_skipped = [&](const AlcoveView& next) {
    run_frame(context(), {&next, 1}, index++);
    return get_state(view).skipped == VK_TRUE;
  };
  EXPECT_FALSE(is_skipped(view));
  view.static_frames = 5;
  EXPECT_TRUE(is_skipped(view));

  // Each change is recorded once, and so is the change back.
  AlcoveSettings larger = *view.settings;
  larger.radius *= 2.0f;
  const std::function<void(AlcoveView&)> changes[] = {
      [](AlcoveView& v) { v.static_frames = 0; },
      [](AlcoveView& v) { v.reset_history = VK_TRUE; },
      [](AlcoveView& v) { v.skip_converged = VK_FALSE; },
      [](AlcoveView& v) { v.camera.view_from_world[12] += 0.1f; },
      [](AlcoveView& v) { v.camera.clip_from_view[0] *= 1.01f; },
      [](AlcoveView& v) { v.normals = {}; },
      [](AlcoveView& v) { v.read_area = kWhole; },
      [](AlcoveView& v) { v.read_area = v.written_area = kPart; },
      [&](AlcoveView& v) { v.settings = &larger; },
      [&](AlcoveView& v) {
        v.visibility = output(VK_FORMAT_R32_SFLOAT, 24, 16);
        v.visibility.initial_state = kResting;
      },
      [](AlcoveView& v) { v.visibility.initial_state.layout = VK_IMAGE_LAYOUT_UNDEFINED; }};
  for (const auto& change : changes) {
    SCOPED_TRACE(&change - changes);
    AlcoveView other = view;
    change(other);
    EXPECT_FALSE(is_skipped(other));
    (void)is_skipped(view);
    EXPECT_TRUE(is_skipped(view));
  }
  discard_frame(context(), {&view, 1}, index++);
  EXPECT_EQ(get_state(view).frames, 0u);
  EXPECT_FALSE(is_skipped(view));
  EXPECT_TRUE(is_skipped(view));
  EXPECT_EQ(alcoveDropView(&context(), view.id), ALCOVE_SUCCESS);
  EXPECT_EQ(get_state(view).frames, 0u);
  EXPECT_FALSE(is_skipped(view));
}

TEST_F(CStillImage, SkippedViewsDoNotDisturbOtherViewsOfTheFrame) {
  HostView moving = draw_still(32);
  moving.id = 1;
  std::array<AlcoveView, 2> views{create_skipping_view(draw_without_history()),
                                  create_skipping_view(moving)};
  Results first;
  for (std::uint32_t i = 0; i < 4; ++i) {
    views[0].static_frames = i;
    run_frame(context(), views, i);
    engine().wait();
    if (i == 0) first = read_results(views[0]);
    EXPECT_EQ(get_state(views[0]).skipped, i > 0 ? VK_TRUE : VK_FALSE);
    EXPECT_EQ(get_state(views[1]).skipped, VK_FALSE);
    expect_equal(read_results(views[1]), run_by_cpp(moving, i));
    expect_equal(read_results(views[0]), first);
  }
}

TEST_F(CStillImage, ImageWhoseNoiseChangesNeverConverges) {
  AlcoveView view = create_skipping_view(draw_still(0));
  EXPECT_EQ(alcoveGetConvergedFrames(view.settings), 0u);
  run_still({&view, 1}, 0, 3);
  EXPECT_EQ(get_state(view).skipped, VK_FALSE);
}

}  // namespace
}  // namespace alcove::passes
