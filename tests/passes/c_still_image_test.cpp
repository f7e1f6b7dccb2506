// Tests of still images, and of views that are skipped once they have converged.
#include <gmock/gmock.h>

#include "c_interface_fixture.h"
#include "gtao_scenes.h"

namespace alcove::passes {
namespace {

using testing::HasSubstr;
using testing::Not;

class CStillImage : public CInterface {
 protected:
  static GivenView given_still(std::uint32_t history_frames) {
    GivenView given = given_view(test_views()[2], 24, 16, ball_on_floor());
    given.settings = quality_settings(Quality::low, 0.4f);
    given.settings.history_frames = history_frames;
    given.settings.precision = Precision::float32;
    given.motion = {};
    return given;
  }

  // The view of view_of() with an output that keeps its contents from frame to frame, and that
  // fill_image() can fill.
  AlcoveView skipping_view_of(const GivenView& given, AlcoveSettings& settings) {
    AlcoveView view = view_of(given, settings);
    view.skip_converged = VK_TRUE;
    view.visibility = engine().make_image(view.visibility.format, 24, 16,
                                          view.visibility.usage | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    return view;
  }

  AlcoveViewState state_of(AlcoveContext& context, std::uint32_t id) {
    AlcoveViewState state{.struct_size = sizeof state};
    EXPECT_EQ(alcoveGetViewState(&context, id, &state), ALCOVE_SUCCESS);
    return state;
  }

  // Runs the frames `first` to `last` of a still image.
  void run_still(AlcoveContext& context, AlcoveView& view, std::uint32_t first,
                 std::uint32_t last) {
    for (std::uint32_t number = first; number <= last; ++number) {
      ASSERT_EQ(alcoveSetStillFrame(number, &view), ALCOVE_SUCCESS);
      run_frame(context, {&view, 1}, number);
    }
    engine().wait();
  }
};

TEST_F(CStillImage, EqualsTheConvergedFramesOfTheCppInterface) {
  const Context context = create_context();
  GivenView given = given_still(32);
  given.settings.bent_normal = true;
  AlcoveSettings settings{};
  AlcoveView view = view_of(given, settings);
  const std::uint32_t frames = alcoveGetConvergedFrames(&settings);
  ASSERT_EQ(frames, 128u);
  run_still(*context, view, 0, frames - 1);
  Results expected;
  for (std::uint32_t i = 0; i < frames; ++i) {
    given.static_frames = i;
    given.reset = i == 0;
    expected = run_by_cpp(given, i);
  }
  expect_equal(results_of(view), expected);
}

TEST_F(CStillImage, ConvergedViewIsSkippedUntilItChanges) {
  const Context context = create_context();
  const Context other = create_context();  // is not given the frames that do nothing
  AlcoveSettings settings{};
  const GivenView given = given_still(8);
  AlcoveView view = skipping_view_of(given, settings);
  AlcoveSettings other_settings{};
  AlcoveView same = view_of(given, other_settings);
  for (std::uint32_t number = 0; number < 128; ++number) {
    run_still(*context, view, number, number);
    const AlcoveViewState state = state_of(*context, view.id);
    ASSERT_EQ(state.frames, number + 1);
    ASSERT_EQ(state.converged_frames, 128u);
    ASSERT_EQ(state.skipped, VK_FALSE) << number;
  }
  EXPECT_THAT(plan_of(*context), HasSubstr("gtao"));
  run_still(*other, same, 0, 127);
  const Results converged = results_of(view);
  expect_equal(results_of(same), converged);

  // Other contents show that nothing is written.
  const HostImage mark{24, 16, std::vector<float>(std::size_t{24} * 16, 0.25f)};
  fill_image(view.visibility, mark, kResting);
  run_still(*context, view, 128, 131);
  EXPECT_EQ(state_of(*context, view.id).skipped, VK_TRUE);
  EXPECT_THAT(plan_of(*context), Not(HasSubstr("gtao")));
  EXPECT_EQ(results_of(view).visibility.texels, mark.texels);

  // An image without contents is written, and the history has lost nothing.
  view.visibility.initial_state.layout = VK_IMAGE_LAYOUT_UNDEFINED;
  run_still(*context, view, 132, 132);
  EXPECT_EQ(state_of(*context, view.id).skipped, VK_FALSE);
  run_still(*other, same, 132, 132);
  expect_equal(results_of(view), results_of(same));
  view.visibility.initial_state = kResting;

  // So does a camera that moves again.
  for (const auto& [with, moved] : {std::pair(context.get(), &view), {other.get(), &same}}) {
    moved->static_frames = 0;
    moved->camera.view_from_world[12] += 0.05f;
    run_frame(*with, {moved, 1}, 133);
  }
  engine().wait();
  EXPECT_EQ(state_of(*context, view.id).frames, 1u);
  expect_equal(results_of(view), results_of(same));
}

TEST_F(CStillImage, WhatEndsAConvergedImageIsRecordedAgain) {
  AlcoveSettings settings{};
  GivenView given = given_still(0);
  given.settings.static_noise = true;
  AlcoveView view = skipping_view_of(given, settings);
  ASSERT_EQ(alcoveGetConvergedFrames(&settings), 1u);
  const Context context = create_context();
  std::uint32_t index = 0;
  const auto is_skipped = [&](const AlcoveView& next) {
    run_frame(*context, {&next, 1}, index++);
    return state_of(*context, view.id).skipped == VK_TRUE;
  };
  EXPECT_FALSE(is_skipped(view));
  view.static_frames = 5;
  EXPECT_TRUE(is_skipped(view));

  // Each change is recorded once, and so is the change back.
  AlcoveSettings larger = settings;
  larger.radius *= 2.0f;
  const std::function<void(AlcoveView&)> changes[] = {
      [](AlcoveView& v) { v.static_frames = 0; },
      [](AlcoveView& v) { v.reset_history = VK_TRUE; },
      [](AlcoveView& v) { v.skip_converged = VK_FALSE; },
      [](AlcoveView& v) { v.camera.view_from_world[12] += 0.1f; },
      [](AlcoveView& v) { v.camera.clip_from_view[0] *= 1.01f; },
      [](AlcoveView& v) { v.normals = {}; },
      [](AlcoveView& v) {
        v.read_area = {0, 0, 24, 16};
      },
      [](AlcoveView& v) {
        v.read_area = {0, 0, 24, 16};
        v.written_area = {4, 4, 12, 8};
      },
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
  record_and_throw_away(*context, view, index++);
  EXPECT_EQ(alcoveDiscardFrame(context.get()), ALCOVE_SUCCESS);
  EXPECT_EQ(state_of(*context, view.id).frames, 0u);
  EXPECT_FALSE(is_skipped(view));
  EXPECT_TRUE(is_skipped(view));
  EXPECT_EQ(alcoveDropView(context.get(), view.id), ALCOVE_SUCCESS);
  EXPECT_FALSE(is_skipped(view));
  engine().wait();
}

TEST_F(CStillImage, SkippedViewsDoNotDisturbOtherViewsOfTheFrame) {
  const Context context = create_context();
  GivenView still = given_still(0);
  still.settings.static_noise = true;
  still.id = 1;
  GivenView moving = given_still(32);
  moving.id = 2;
  AlcoveSettings settings[2];
  std::array<AlcoveView, 2> views{skipping_view_of(still, settings[0]),
                                  skipping_view_of(moving, settings[1])};
  Results first;
  for (std::uint32_t i = 0; i < 4; ++i) {
    views[0].static_frames = i;
    run_frame(*context, views, i);
    engine().wait();
    first = i == 0 ? results_of(views[0]) : first;
    EXPECT_EQ(state_of(*context, 1).skipped, i > 0 ? VK_TRUE : VK_FALSE);
    EXPECT_EQ(state_of(*context, 2).skipped, VK_FALSE);
    expect_equal(results_of(views[1]), run_by_cpp(moving, i));
    expect_equal(results_of(views[0]), first);
  }
}

TEST_F(CStillImage, ImageWhoseNoiseChangesNeverConverges) {
  const Context context = create_context();
  AlcoveSettings settings{};
  AlcoveView view = skipping_view_of(given_still(0), settings);
  EXPECT_EQ(alcoveGetConvergedFrames(&settings), 0u);
  run_still(*context, view, 0, 3);
  EXPECT_EQ(state_of(*context, view.id).skipped, VK_FALSE);
}

TEST_F(CStillImage, ArgumentsThatCannotBeUsedAreRefused) {
  const Context context = create_context();
  AlcoveSettings settings{.struct_size = 1};
  EXPECT_EQ(alcoveGetConvergedFrames(nullptr), 0u);
  EXPECT_EQ(alcoveGetConvergedFrames(&settings), 0u);
  AlcoveView view{};
  EXPECT_EQ(alcoveSetStillFrame(0, nullptr), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveSetStillFrame(0, &view), ALCOVE_ERROR_INVALID_INPUT);
  AlcoveViewState state{};
  EXPECT_EQ(alcoveGetViewState(nullptr, 0, &state), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveGetViewState(context.get(), 0, nullptr), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveGetViewState(context.get(), 0, &state), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_THAT(alcoveGetMessage(context.get()), HasSubstr("AlcoveViewState::struct_size is 0"));
  state.struct_size = sizeof state;
  EXPECT_EQ(alcoveGetViewState(context.get(), 77, &state), ALCOVE_SUCCESS);
  EXPECT_EQ(state.frames, 0u);
}

}  // namespace
}  // namespace alcove::passes
