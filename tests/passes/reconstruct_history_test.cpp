// The history, fed with signals that the tests write.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <random>

#include "gtao_scenes.h"
#include "reconstruct_fixture.h"

namespace alcove::passes {
namespace {

TEST_F(Reconstruct, AStaticViewConverges) {
  const TestView view = test_views()[2];
  const Drawing drawing = draw(view, kWidth, kHeight, {tilted_plane(30.0, 4.0)});
  const std::uint32_t seed = 17;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::vector<double> variances;
  HostImage last;
  for (std::uint32_t frame = 0; frame < 40; ++frame) {
    const HostImage raw_occlusion = noise_raw_occlusion(random);
    last = reconstruct(
        {.view = view.view, .drawing = drawing, .raw_occlusion = raw_occlusion, .index = frame},
        precise(1, 32));
    variances.push_back(variance(last));
  }
  EXPECT_LT(variances[7], 0.5 * variances[0]);
  EXPECT_LT(variances[39], 0.1 * variances[0]);
  double mean = 0.0;
  for (const float texel : last.texels) {
    mean += texel / static_cast<double>(last.texels.size());
  }
  EXPECT_NEAR(mean, 0.5, 0.01);
}

// From the 16th frame of a still view on, what a search did not reach stays as it was.
TEST_F(Reconstruct, ASettledViewBringsForwardWhatItsSearchesReached) {
  const TestView view = test_views()[2];
  Surface half = plane({0.0, 0.0, -3.0}, {0.0, 0.0, 1.0});
  half.keep = [](const glm::dvec3& p) { return p.x < 0.4; };
  const Drawing drawing = draw(view, 33, 23, {half});
  for (const std::uint32_t tile_size : {1u, 2u, 4u}) {
    SCOPED_TRACE(testing::Message() << "by " << tile_size);
    // The last two frames of a run whose camera is known to stand still up to frame `known`.
    const auto run_static = [&](std::uint32_t known) {
      std::mt19937 random(11);
      std::uniform_real_distribution<float> noise(0.1f, 0.9f);
      std::array<HostImage, 2> last;
      for (std::uint32_t frame = 0; frame <= 16; ++frame) {
        const HostImage raw_occlusion =
            raw_occlusion_of(blocks(33, tile_size), blocks(23, tile_size),
                             [&](std::uint32_t, std::uint32_t) { return noise(random); });
        last[0] = std::move(last[1]);
        last[1] = reconstruct({.view = view.view,
                               .drawing = drawing,
                               .raw_occlusion = raw_occlusion,
                               .tile_size = tile_size,
                               .index = frame,
                               .reset = frame == 0,
                               .static_frames = frame <= known ? frame : 0},
                              precise(1, 32));
      }
      return last;
    };
    const auto [before, settled] = run_static(16);
    const auto [same, all] = run_static(15);
    EXPECT_THAT(same.texels, testing::Pointwise(testing::FloatEq(), before.texels));
    // Frame 16 searches the first pixel of each block.
    for (std::uint32_t y = 0; y < 23; ++y) {
      for (std::uint32_t x = 0; x < 33; ++x) {
        const std::uint32_t aside = std::min(x % tile_size, tile_size - x % tile_size);
        const std::uint32_t below = std::min(y % tile_size, tile_size - y % tile_size);
        const bool reached = tile_size == 4 ? aside + below <= 1 : aside + below == 0;
        if (reached) {
          ASSERT_EQ(settled.at(x, y), all.at(x, y)) << "at " << x << ", " << y;
        } else {
          // What is stored has 16 bits.
          ASSERT_NEAR(settled.at(x, y), before.at(x, y), 2e-5) << "at " << x << ", " << y;
        }
        if (drawing.is_sky(x, y)) {
          ASSERT_EQ(settled.at(x, y), 1.0f) << "at " << x << ", " << y;
        }
      }
    }
  }
}

// However short the history: where nothing moves there is nothing to follow.
TEST_F(Reconstruct, ASettledViewAveragesAllItsFrames) {
  const TestView view = test_views()[2];
  const Drawing drawing = draw(view, kWidth, kHeight, {tilted_plane(30.0, 4.0)});
  const auto variance_after = [&](bool still) {
    std::mt19937 random(5);
    HostImage last;
    for (std::uint32_t frame = 0; frame < 80; ++frame) {
      const HostImage raw_occlusion = noise_raw_occlusion(random);
      last = reconstruct({.view = view.view,
                          .drawing = drawing,
                          .raw_occlusion = raw_occlusion,
                          .index = frame,
                          .reset = frame == 0,
                          .static_frames = still ? frame : 0},
                         precise(1, 8));
    }
    return variance(last);
  };
  EXPECT_LT(variance_after(true), 0.35 * variance_after(false));
}

TEST_F(Reconstruct, MotionVectorsOfAStillViewAreNotRead) {
  const TestView view = test_views()[2];
  const Drawing drawing = draw(view, kWidth, kHeight, {tilted_plane(30.0, 4.0)});
  std::mt19937 random(3);
  const HostImage first = noise_raw_occlusion(random);
  const HostImage second = noise_raw_occlusion(random);
  HostImage wrong{kWidth, kHeight, {}, 2};
  wrong.texels.assign(std::size_t{kWidth} * kHeight * 2, 0.25f);
  const auto second_frame = [&](const HostImage* motion) {
    (void)reconstruct(
        {.view = view.view, .drawing = drawing, .raw_occlusion = first, .reset = true},
        precise(1, 8));
    return reconstruct({.view = view.view,
                        .drawing = drawing,
                        .raw_occlusion = second,
                        .motion = motion,
                        .index = 1,
                        .static_frames = 1},
                       precise(1, 8));
  };
  EXPECT_EQ(second_frame(&wrong).texels, second_frame(nullptr).texels);
}

// A history of many more frames than it counts: what is stored must neither drift nor lock.
TEST_F(Reconstruct, HundredsOfEqualFramesDoNotDrift) {
  const TestView view = test_views()[2];
  const Drawing drawing = draw(view, 9, 7, {tilted_plane(30.0, 4.0)});
  for (const float visibility : {0.013f, 0.37f, 0.985f, 1.0f}) {
    SCOPED_TRACE(visibility);
    const HostImage raw_occlusion = constant_raw_occlusion(9, 7, visibility);
    HostImage found;
    for (std::uint32_t frame = 0; frame < 250; ++frame) {
      found = reconstruct({.view = view.view,
                           .drawing = drawing,
                           .raw_occlusion = raw_occlusion,
                           .index = frame,
                           .reset = frame == 0},
                          precise(1, 127));
    }
    EXPECT_THAT(found.texels, testing::Each(testing::FloatNear(visibility, 2e-3f)));
    // From a wrong start the history comes back to within what it can store.
    const HostImage wrong = constant_raw_occlusion(9, 7, 1.0f - visibility);
    for (std::uint32_t frame = 0; frame < 130; ++frame) {
      found = reconstruct({.view = view.view,
                           .drawing = drawing,
                           .raw_occlusion = frame == 0 ? wrong : raw_occlusion,
                           .index = frame,
                           .reset = frame == 0},
                          precise(1, 8));
    }
    EXPECT_THAT(found.texels, testing::Each(testing::FloatNear(visibility, 4e-3f)));
  }
}

TEST_F(Reconstruct, ARestartForgetsWhatWas) {
  const TestView view = test_views()[2];
  const Drawing drawing = draw(view, kWidth, kHeight, {tilted_plane(30.0, 4.0)});
  const Drawing smaller = draw(view, kWidth - 3, kHeight, {tilted_plane(30.0, 4.0)});
  const HostImage dark = constant_raw_occlusion(kWidth, kHeight, 0.1f);
  const HostImage bright = constant_raw_occlusion(kWidth, kHeight, 0.9f);
  const HostImage bright_smaller = constant_raw_occlusion(kWidth - 3, kHeight, 0.9f);
  const ReconstructSettings settings = precise(1, 32);
  const auto gather_dark = [&] {
    for (std::uint32_t frame = 0; frame < 6; ++frame) {
      (void)reconstruct(
          {.view = view.view, .drawing = drawing, .raw_occlusion = dark, .index = frame}, settings);
    }
  };

  gather_dark();
  const HostImage kept =
      reconstruct({.view = view.view, .drawing = drawing, .raw_occlusion = bright}, settings);
  EXPECT_THAT(kept.texels, testing::Each(testing::Lt(0.5f)));
  gather_dark();
  const HostImage reset = reconstruct(
      {.view = view.view, .drawing = drawing, .raw_occlusion = bright, .reset = true}, settings);
  EXPECT_THAT(reset.texels, testing::Each(testing::FloatNear(0.9f, 2e-3f)));
  gather_dark();
  const HostImage resized = reconstruct(
      {.view = view.view, .drawing = smaller, .raw_occlusion = bright_smaller}, settings);
  EXPECT_THAT(resized.texels, testing::Each(testing::FloatNear(0.9f, 2e-3f)));
}

}  // namespace
}  // namespace alcove::passes
