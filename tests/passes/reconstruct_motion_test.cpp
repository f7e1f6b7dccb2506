// Tests the history while the camera or surfaces move, with raw occlusion that the tests write.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "gtao_scenes.h"
#include "reconstruct_fixture.h"

namespace alcove::passes {
namespace {

// The camera jumps sideways. Pixels whose surface was not visible before start a new history, and
// the others keep theirs.
TEST_F(Reconstruct, PixelsUncoveredByACameraJumpStartANewHistory) {
  const TestView view = test_views()[2];
  const double leap = 0.8;
  Scene before = step(0.3, 1.5, 5.0);
  const Drawing first = draw(view, kWidth, kHeight, before);
  // The scene is static. In the view space of the moved camera it is shifted to the left by `leap`.
  const Drawing second = draw(view, kWidth, kHeight, step(0.3 - leap, 1.5, 5.0));
  AlcoveCamera moved = view.view;
  moved.view_from_world[12] = static_cast<float>(-leap);

  const HostImage dark = constant_raw_occlusion(kWidth, kHeight, 0.1f);
  const HostImage bright = constant_raw_occlusion(kWidth, kHeight, 0.9f);
  for (std::uint32_t frame = 0; frame < 8; ++frame) {
    (void)reconstruct({.drawing = first, .raw_occlusion = dark, .index = frame}, precise(32));
  }
  const HostImage image = reconstruct({.drawing = second,
                                       .raw_occlusion = bright,
                                       .view = moved,
                                       .previous_view = view.view,
                                       .index = 8},
                                      precise(32));
  int uncovered_pixels = 0;
  int visible_pixels = 0;
  for (std::uint32_t y = 0; y < kHeight; ++y) {
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      const auto hit = cast(second.scene, second.camera.ray(x + 0.5, y + 0.5));
      const glm::dvec3 was = hit->position + glm::dvec3(leap, 0.0, 0.0);
      const glm::dvec3 pixel = first.camera.project(was);
      // Pixels within one or two pixels of an edge are not tested, because some of their four
      // history texels show another surface.
      const bool outside = pixel.x < -0.5 || pixel.x > kWidth + 0.5;
      const bool well_inside =
          pixel.x > 2.0 && pixel.x < kWidth - 2.0 && pixel.y > 2.0 && pixel.y < kHeight - 2.0;
      bool hidden = true;
      bool seen = true;
      for (const double aside : {-1.5, 0.0, 1.5}) {
        const auto there = cast(first.scene, first.camera.ray(pixel.x + aside, pixel.y));
        const bool same = there && std::abs(there->position.z - was.z) < 0.02 * std::abs(was.z);
        hidden = hidden && !same;
        seen = seen && same;
      }
      if (std::abs(hit->normal.z) < 0.5) continue;
      if (outside || hidden) {
        ASSERT_NEAR(image.at(x, y), 0.9f, 0.01) << "at " << x << ", " << y;
        ++uncovered_pixels;
      } else if (seen && well_inside) {
        ASSERT_LT(image.at(x, y), 0.6f) << "at " << x << ", " << y;
        ++visible_pixels;
      }
    }
  }
  EXPECT_GT(uncovered_pixels, 30);
  EXPECT_GT(visible_pixels, 200);
}

// A dark and a bright wall meet, and the camera moves slowly sideways. Neither wall may get the
// history of the other. The view is narrow, because the differences of depth between the walls are
// small then.
TEST_F(Reconstruct, HistoryOfOneWallDoesNotLeakToAnotherAcrossACrease) {
  TestView view = test_views()[2];
  const float zoom = 2.0f;
  view.view.clip_from_view[0] *= zoom;
  view.view.clip_from_view[5] *= zoom;
  const double creep = 0.05 / zoom;  // a third of a pixel
  AlcoveCamera before = view.view;
  HostImage image;
  HostImage raw_occlusion;
  for (std::uint32_t frame = 0; frame < 12; ++frame) {
    AlcoveCamera now = view.view;
    now.view_from_world[12] = static_cast<float>(-creep * frame);
    const Drawing drawing = draw(view, kWidth, kHeight, groove(0.8, 4.5, -creep * frame));
    raw_occlusion = raw_occlusion_of(kWidth, kHeight, [&](std::uint32_t x, std::uint32_t y) {
      return cast(drawing.scene, drawing.camera.ray(x + 0.5, y + 0.5))->normal.x > 0.0 ? 0.2f
                                                                                       : 0.9f;
    });
    image = reconstruct({.drawing = drawing,
                         .raw_occlusion = raw_occlusion,
                         .view = now,
                         .previous_view = before,
                         .index = frame},
                        precise(32));
    before = now;
  }
  double worst = 0.0;
  for (std::uint32_t y = 0; y < kHeight; ++y) {
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      const std::size_t i = std::size_t{y} * kWidth + x;
      worst =
          std::max<double>(worst, std::abs(image.texels[i] - raw_occlusion.texels[i * 2] /
                                                                 raw_occlusion.texels[i * 2 + 1]));
    }
  }
  // The tolerance is not smaller, because history texels are distinguished by their depth alone.
  EXPECT_LT(worst, 0.1);
}

// The camera rotates in front of a corner of two walls, which bend each other's bent normals. The
// accumulated bent normals must rotate with the camera: their mean must be that of frames without a
// history.
TEST_F(Reconstruct, AccumulatedBentNormalsRotateWithTheCamera) {
  OcclusionSettings settings(ALCOVE_QUALITY_HIGH, 4.0f);
  settings.slices = 3;  // two leave too much noise in a frame without history
  settings.bent_normal = true;
  settings.precision = ALCOVE_PRECISION_FLOAT32;
  // Returns the mean bent normal of the left wall in the last frame. The right wall is left out,
  // because its errors would cancel those of the left one.
  const auto mean_bent_normal = [&] {
    glm::dvec3 sum(0.0);
    AlcoveCamera before;
    for (std::uint32_t frame = 0; frame < 8; ++frame) {
      TestView now = test_views()[2];
      const glm::dmat4 rotation =
          glm::rotate(glm::dmat4(1.0), 0.05 * frame - 0.2, glm::dvec3(0.0, 1.0, 0.0));
      for (int i = 0; i < 16; ++i) {
        now.view.view_from_world[i] = static_cast<float>(rotation[i / 4][i % 4]);
      }
      const glm::dmat3 view_from_world(rotation);
      const auto wall = [&](const glm::dvec3& normal_ws) {
        return plane(view_from_world * glm::dvec3(0.0, 0.0, -4.0),
                     view_from_world * glm::normalize(normal_ws));
      };
      const Drawing drawing =
          draw(now, kWidth, kHeight,
               {wall(glm::dvec3(1.0, 0.0, 1.0)), wall(glm::dvec3(-1.0, 0.0, 1.0))});
      HostView view = make_view(drawing, settings, frame);
      view.previous_view = frame == 0 ? now.view : before;
      const HostImage bent = run_occlusion(view, frame).bent_normal;
      sum = glm::dvec3(0.0);
      for (std::size_t i = 0; i < bent.texels.size(); i += 4) {
        const glm::dvec3 normal(drawing.normal_vs.texels[i], drawing.normal_vs.texels[i + 1],
                                drawing.normal_vs.texels[i + 2]);
        if ((glm::transpose(view_from_world) * normal).x > 0.0) {
          sum += glm::dvec3(bent.texels[i], bent.texels[i + 1], bent.texels[i + 2]);
        }
      }
      before = now.view;
    }
    return glm::normalize(sum);
  };
  const glm::dvec3 with_history = mean_bent_normal();
  settings.history_frames = 0;
  // A history that is not rotated with the camera would have an error above 0.1.
  EXPECT_LT(glm::distance(with_history, mean_bent_normal()), 0.02);
}

// A plane with a pattern moves by three pixels per frame. With motion vectors the pattern stays
// sharp, without them it is blurred.
TEST_F(Reconstruct, MotionVectorsKeepThePatternOfAMovingPlaneSharp) {
  const Drawing drawing = draw_plane(0.0);
  const std::uint32_t speed = 3;
  const auto pattern_at = [&](std::uint32_t frame) {
    return raw_occlusion_of(kWidth, kHeight, [&](std::uint32_t x, std::uint32_t) {
      return (x + 300 - speed * frame) % 16 < 8 ? 0.9f : 0.1f;
    });
  };
  HostImage motion{kWidth, kHeight, {}, 2};
  for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
    motion.texels.push_back(static_cast<float>(speed) / static_cast<float>(kWidth));
    motion.texels.push_back(0.0f);
  }
  for (const bool with_motion : {true, false}) {
    HostImage image;
    HostImage raw_occlusion;
    for (std::uint32_t frame = 0; frame < 10; ++frame) {
      raw_occlusion = pattern_at(frame);
      image = reconstruct({.drawing = drawing,
                           .raw_occlusion = raw_occlusion,
                           .motion = with_motion ? &motion : nullptr,
                           .index = frame},
                          precise(32));
    }
    // Compare only columns that have shown the plane since the first frame.
    double error = 0.0;
    int count = 0;
    for (std::uint32_t y = 0; y < kHeight; ++y) {
      for (std::uint32_t x = 28; x < kWidth; ++x) {
        const std::size_t i = std::size_t{y} * kWidth + x;
        error += std::abs(image.texels[i] -
                          raw_occlusion.texels[i * 2] / raw_occlusion.texels[i * 2 + 1]);
        ++count;
      }
    }
    if (with_motion)
      EXPECT_LT(error / count, 0.12);
    else
      EXPECT_GT(error / count, 0.2);
  }
}

// A plane moves by one pixel per frame and comes nearer by a hundredth of its distance. Motion
// vectors do not contain the change of distance, but the plane must keep its history. Then a static
// plane appears as far behind it as an uncovered surface would, and must start a new history.
TEST_F(Reconstruct, ApproachingSurfaceKeepsItsHistory) {
  const double nearer = 0.99;
  const std::uint32_t frames = 24;
  HostImage motion{kWidth, kHeight, {}, 2};
  for (std::uint32_t y = 0; y < kHeight; ++y) {
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      const double right = x + 0.5 - 0.5 * kWidth;
      const double down = y + 0.5 - 0.5 * kHeight;
      motion.texels.push_back(static_cast<float>((right * (1.0 - nearer) + 1.0) / kWidth));
      motion.texels.push_back(static_cast<float>(down * (1.0 - nearer) / kHeight));
    }
  }
  std::mt19937 random(23);
  // Returns the variance over the pixels whose surface has been on the image for many frames.
  const auto spread = [](const HostImage& image) {
    HostImage half{kWidth / 2, kHeight, {}, 1};
    for (std::uint32_t y = 0; y < kHeight; ++y)
      for (std::uint32_t x = kWidth / 2; x < kWidth; ++x) half.texels.push_back(image.at(x, y));
    return variance(half);
  };
  double first = 0.0;
  double distance = 5.0;
  HostImage image;
  for (std::uint32_t frame = 0; frame < frames; ++frame, distance *= nearer) {
    const Drawing drawing = draw_plane(0.0, distance);
    const HostImage raw_occlusion = noise_raw_occlusion(random);
    image = reconstruct(
        {.drawing = drawing, .raw_occlusion = raw_occlusion, .motion = &motion, .index = frame},
        precise(32));
    first = frame == 0 ? spread(image) : first;
  }
  EXPECT_LT(spread(image), 0.3 * first);

  const HostImage still = no_motion();
  const Drawing behind = draw_plane(0.0, distance / nearer * 1.02);
  const HostImage bright = constant_raw_occlusion(kWidth, kHeight, 0.9f);
  const HostImage uncovered = reconstruct(
      {.drawing = behind, .raw_occlusion = bright, .motion = &still, .index = frames}, precise(32));
  EXPECT_THAT(uncovered.texels, testing::Each(testing::FloatNear(0.9f, 2e-3f)));
}

// An occluder moves away from a static plane, and later comes back. Motion vectors, even if they
// are 0, tell the pass that occluders may move, so that the plane's visibility changes within a few
// frames.
TEST_F(Reconstruct, VisibilityAdaptsWithinTwelveFramesOfAnOccludersMotionIfMotionVectorsAreGiven) {
  const Drawing drawing = draw_plane(30.0);
  const HostImage motion = no_motion();
  const std::uint32_t long_ago = 30;
  const std::uint32_t soon = 12;
  for (const bool half_resolution : {false, true}) {
    const std::uint32_t tile_size = half_resolution ? 2 : 1;
    const HostImage shaded = constant_raw_occlusion(kWidth / tile_size, kHeight / tile_size, 0.6f);
    const HostImage open = constant_raw_occlusion(kWidth / tile_size, kHeight / tile_size, 1.0f);
    OcclusionSettings settings = precise(32);
    settings.half_resolution = half_resolution;
    for (const bool with_motion : {true, false}) {
      SCOPED_TRACE(testing::Message()
                   << "half resolution " << half_resolution << ", motion vectors " << with_motion);
      std::vector<HostImage> images;
      for (std::uint32_t frame = 0; frame < long_ago + 2 * soon; ++frame) {
        const bool is_open = frame >= long_ago && frame < long_ago + soon;
        images.push_back(reconstruct({.drawing = drawing,
                                      .raw_occlusion = is_open ? open : shaded,
                                      .tile_size = tile_size,
                                      .motion = with_motion ? &motion : nullptr,
                                      .index = frame},
                                     settings));
      }
      // The tolerances are wide because recent occlusion is stored in 4 bits, with dithering.
      const auto left = testing::Each(testing::Gt(0.93f));
      const auto back = testing::Each(testing::Lt(0.75f));
      EXPECT_THAT(images[long_ago - 1].texels, testing::Each(testing::FloatNear(0.6f, 5e-3f)));
      if (with_motion) {
        EXPECT_THAT(images[long_ago + soon - 1].texels, left);
        EXPECT_THAT(images[long_ago + 2 * soon - 1].texels, back);
      } else {
        EXPECT_THAT(images[long_ago + soon - 1].texels, testing::Each(testing::Lt(0.9f)));
      }
    }
  }
}

// In the second frame another surface is visible, without motion vectors that would tell it.
TEST_F(Reconstruct, PixelsWhoseHistoryIsRejectedAreFilteredAsInAFirstFrame) {
  const Drawing before = draw_plane(30.0);
  const Drawing now = draw_plane(30.0, 9.0);
  std::mt19937 random(3);
  const HostImage first_raw_occlusion = noise_raw_occlusion(random);
  const HostImage raw_occlusion = noise_raw_occlusion(random);
  const auto second_frame = [&](bool reset) {
    (void)reconstruct({.drawing = before, .raw_occlusion = first_raw_occlusion}, precise(32));
    return reconstruct({.drawing = now, .raw_occlusion = raw_occlusion, .index = 1, .reset = reset},
                       precise(32));
  };
  EXPECT_THAT(second_frame(false).texels,
              testing::Pointwise(testing::FloatNear(1e-3f), second_frame(true).texels));
}

}  // namespace
}  // namespace alcove::passes
