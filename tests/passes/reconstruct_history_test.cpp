// Tests the history with raw occlusion that the tests write.
#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "gtao_scenes.h"
#include "reconstruct_fixture.h"

namespace alcove::passes {
namespace {

TEST_F(Reconstruct, NoiseOfAStaticViewDecreasesOverFrames) {
  const TestView view = test_views()[2];
  const Drawing drawing = draw_plane(30.0);
  const std::uint32_t seed = 17;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::vector<double> variances;
  HostImage last;
  for (std::uint32_t frame = 0; frame < 40; ++frame) {
    const HostImage raw_occlusion = noise_raw_occlusion(random);
    last = reconstruct({.drawing = drawing, .raw_occlusion = raw_occlusion, .index = frame},
                       precise(32));
    variances.push_back(variance(last));
  }
  EXPECT_LT(variances[7], 0.5 * variances[0]);
  EXPECT_LT(variances[39], 0.1 * variances[0]);
  EXPECT_NEAR(mean(last), 0.5, 0.01);
}

// A view that has been static for 16 frames averages up to 127 of them, independent of
// history_frames.
TEST_F(Reconstruct, StaticViewAveragesMoreFramesThanTheHistoryFramesSetting) {
  const Drawing drawing = draw_plane(30.0);
  const auto variance_after = [&](bool still) {
    std::mt19937 random(5);
    HostImage last;
    for (std::uint32_t frame = 0; frame < 80; ++frame) {
      const HostImage raw_occlusion = noise_raw_occlusion(random);
      last = reconstruct({.drawing = drawing,
                          .raw_occlusion = raw_occlusion,
                          .index = frame,
                          .static_frames = still ? frame : 0},
                         precise(8));
    }
    return variance(last);
  };
  EXPECT_LT(variance_after(true), 0.35 * variance_after(false));
}

TEST_F(Reconstruct, MotionVectorsOfAStaticViewAreNotRead) {
  const Drawing drawing = draw_plane(30.0);
  std::mt19937 random(3);
  const HostImage first = noise_raw_occlusion(random);
  const HostImage second = noise_raw_occlusion(random);
  HostImage wrong = no_motion();
  std::ranges::fill(wrong.texels, 0.25f);
  const auto second_frame = [&](const HostImage* motion) {
    (void)reconstruct({.drawing = drawing, .raw_occlusion = first}, precise(8));
    return reconstruct({.drawing = drawing,
                        .raw_occlusion = second,
                        .motion = motion,
                        .index = 1,
                        .static_frames = 1},
                       precise(8));
  };
  EXPECT_EQ(second_frame(&wrong).texels, second_frame(nullptr).texels);
}

// Accumulates many more frames than the history's largest weight. Visibility is stored in steps of
// 2^-10 with dithering, so that single pixels may differ by a few steps. The mean over all pixels
// must not drift, and it must still follow a change.
TEST_F(Reconstruct, AccumulatedVisibilityDoesNotDriftOverHundredsOfEqualFrames) {
  const Drawing drawing = draw(test_views()[2], 9, 7, {tilted_plane(30.0, 4.0)});
  for (const float visibility : {0.013f, 0.37f, 0.985f, 1.0f}) {
    SCOPED_TRACE(visibility);
    const HostImage raw_occlusion = constant_raw_occlusion(9, 7, visibility);
    HostImage image;
    for (std::uint32_t frame = 0; frame < 250; ++frame) {
      image = reconstruct({.drawing = drawing, .raw_occlusion = raw_occlusion, .index = frame},
                          precise(127));
    }
    const auto expect_visibility = [&] {
      EXPECT_THAT(image.texels,
                  testing::Each(testing::FloatNear(visibility, visibility == 1.0f ? 0.0f : 5e-3f)));
      EXPECT_NEAR(mean(image), visibility, 1e-3);
    };
    expect_visibility();
    // A history with wrong contents returns to the right value within its quantisation step.
    const HostImage wrong = constant_raw_occlusion(9, 7, 1.0f - visibility);
    for (std::uint32_t frame = 0; frame < 130; ++frame) {
      image = reconstruct(
          {.drawing = drawing, .raw_occlusion = frame == 0 ? wrong : raw_occlusion, .index = frame},
          precise(8));
    }
    expect_visibility();
  }
}

// A wall is replaced by another behind it, at depths near both ends of the view's range.
TEST_F(Reconstruct, SurfaceThatReplacesAnotherTakesNothingFromItsHistory) {
  const HostImage closed = constant_raw_occlusion(kWidth, kHeight, 0.0f);
  const HostImage open = constant_raw_occlusion(kWidth, kHeight, 1.0f);
  for (const TestView& view : {test_views()[2], orthographic_view("", 3.0, 2.0, 0.1, 20.0)}) {
    for (const auto& [before, after] : {std::pair{2.0, 3.0}, {12.0, 17.0}}) {
      SCOPED_TRACE(testing::Message() << view.name << " " << before);
      const Drawing drawing = draw(view, kWidth, kHeight, {tilted_plane(0.0, before)});
      const Drawing replaced = draw(view, kWidth, kHeight, {tilted_plane(0.0, after)});
      for (const Drawing* second : {&drawing, &replaced}) {
        (void)reconstruct({.drawing = drawing, .raw_occlusion = closed}, precise(32));
        const HostImage result =
            reconstruct({.drawing = *second, .raw_occlusion = open, .index = 1}, precise(32));
        if (second == &drawing)
          EXPECT_LT(mean(result), 0.7);
        else
          EXPECT_NEAR(mean(result), 1.0, 0.001);
      }
    }
  }
}

TEST_F(Reconstruct, ResetOrChangedImageSizeDiscardsTheHistory) {
  const Drawing drawing = draw_plane(30.0);
  const Drawing smaller = draw(test_views()[2], kWidth - 3, kHeight, {tilted_plane(30.0, 4.0)});
  const HostImage dark = constant_raw_occlusion(kWidth, kHeight, 0.1f);
  const OcclusionSettings settings = precise(32);
  // Returns a bright frame after six dark ones.
  const auto seventh_frame = [&](const Drawing& last, bool reset) {
    for (std::uint32_t frame = 0; frame < 6; ++frame)
      (void)reconstruct({.drawing = drawing, .raw_occlusion = dark, .index = frame}, settings);
    const HostImage bright = constant_raw_occlusion(last.depth_ndc.width, kHeight, 0.9f);
    return reconstruct({.drawing = last, .raw_occlusion = bright, .index = 6, .reset = reset},
                       settings)
        .texels;
  };
  const auto is_bright = testing::Each(testing::FloatNear(0.9f, 2e-3f));
  EXPECT_THAT(seventh_frame(drawing, false), testing::Each(testing::Lt(0.5f)));
  EXPECT_THAT(seventh_frame(drawing, true), is_bright);
  EXPECT_THAT(seventh_frame(smaller, false), is_bright);
}

}  // namespace
}  // namespace alcove::passes
