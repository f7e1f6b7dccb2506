// Checks `alcove compare --split` on views in which one cause of the error is known to dominate.
#include "evaluate/error_split.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gpu_test.h"
#include "scene/builtin_scene.h"
#include "scene/shapes.h"
#include "traced_truth.h"

namespace alcove::sample {
namespace {

class ErrorSplitTest : public GpuTest {
 protected:
  // The scene's first camera.
  static StaticSetup setup_of(const Scene& scene, std::uint32_t frames) {
    return {{160, 90, NormalSource::geometric, frames}, scene.cameras.front()};
  }
  TracedTruth truth_of(const Scene& scene, const OcclusionSettings& settings) {
    const StaticSetup setup = setup_of(scene, 1);
    return trace_truth(scene, setup.camera, settings.radius,
                       draw_static(gpu(), scene, setup, settings).value());
  }
  ErrorSplit split(const Scene& scene, const OcclusionSettings& settings, std::uint32_t frames) {
    const TracedTruth truth = truth_of(scene, settings);
    const auto found = split_error(gpu(), scene, setup_of(scene, frames), settings,
                                   truth.visibility, truth.surfaces);
    EXPECT_TRUE(found) << found.error();
    double sum = 0;
    for (const ErrorCause& cause : found->causes) sum += std::max(cause.share, 0.0);
    EXPECT_EQ(found->causes.size(), 6u);
    EXPECT_NEAR(sum, 1.0, 1e-6);
    return *found;
  }

  // Expects that the cause with this number has the largest share.
  static void expect_largest(const ErrorSplit& split, std::size_t expected) {
    const auto largest = std::ranges::max_element(split.causes, {}, &ErrorCause::share);
    EXPECT_EQ(static_cast<std::size_t>(largest - split.causes.begin()), expected)
        << format_table(split);
  }
};

OcclusionSettings medium_settings(float radius) {
  return OcclusionSettings(ALCOVE_QUALITY_MEDIUM, radius);
}

Scene scene_of(SceneBuilder& builder, const Camera& camera) {
  Scene scene = builder.finish("split");
  scene.cameras = {camera};
  return scene;
}

// Of the squared error of single frames, the mean of many frames lacks the noise only.
TEST_F(ErrorSplitTest, NoiseIsTheErrorThatTheMeanOfManyFramesLacks) {
  OcclusionSettings settings = medium_settings(0.5f);
  settings.tile_size = 1;
  settings.slices = 1;
  settings.history_frames = 0;
  const Scene scene = builtin_scene();
  const ErrorSplit found = split(scene, settings, 1);
  const TracedTruth truth = truth_of(scene, settings);
  constexpr std::uint32_t kFrames = 16;
  StaticSetup setup = setup_of(scene, 1);
  Image<float> mean(setup.width, setup.height);
  double single = 0;
  for (; setup.first_frame < kFrames; ++setup.first_frame) {
    const Image<float> frame = draw_static(gpu(), scene, setup, settings).value().visibility;
    single += std::pow(truth.rmse(frame), 2) / kFrames;
    for (std::size_t i = 0; i < mean.pixels.size(); ++i)
      mean.pixels[i] += frame.pixels[i] / kFrames;
  }
  const double noise = single - std::pow(truth.rmse(mean), 2);
  EXPECT_NEAR(found.causes.front().share * std::pow(found.rmse, 2), noise, 0.2 * noise);
}

TEST_F(ErrorSplitTest, OnePixelInSixtyFourOfThinBarsIsMostlyFilterAndTiles) {
  SceneBuilder builder;
  builder.use(builder.add_material("wood", glm::vec3(0.6f), 0.8f));
  builder.box({-3.0f, -0.1f, -3.0f}, {3.0f, 0.0f, 3.0f});
  for (int i = -30; i <= 30; ++i) {
    const float x = 0.08f * static_cast<float>(i);
    builder.box({x, 0.0f, -1.0f}, {x + 0.04f, 0.04f, 1.5f});
  }
  OcclusionSettings settings = medium_settings(0.15f);
  settings.tile_size = 8;
  settings.half_resolution = true;
  settings.slices = 16;
  settings.history_frames = 64;
  const Camera camera{.eye_ws = {0.1f, 1.6f, 0.6f}, .target_ws = {0.0f, 0.0f, 0.2f}};
  expect_largest(split(scene_of(builder, camera), settings, 64), 1);
}

// A plate near the eye covers the image of a wall, beside which the floor is visible.
TEST_F(ErrorSplitTest, WallBehindAPlateIsMostlyAHiddenSurface) {
  SceneBuilder builder;
  builder.use(builder.add_material("stone", glm::vec3(0.6f), 0.8f));
  builder.box({-5.0f, -0.1f, -2.0f}, {5.0f, 0.0f, 3.0f});
  builder.box({-5.0f, 0.0f, -0.3f}, {5.0f, 1.5f, -0.2f});
  builder.box({-2.0f, 0.965f, 2.39f}, {2.0f, 2.0f, 2.4f});
  const Camera camera{.eye_ws = {0.0f, 1.2f, 3.0f}, .target_ws = {0.0f, 0.0f, 0.2f}, .fov_y = 0.8f};
  expect_largest(split(scene_of(builder, camera), medium_settings(0.5f), 16), 2);
}

// The eye looks down at a floor; the wall beside it begins just outside the image.
TEST_F(ErrorSplitTest, WallBesideTheImageIsMostlyOutside) {
  SceneBuilder builder;
  builder.use(builder.add_material("stone", glm::vec3(0.6f), 0.8f));
  builder.box({-5.0f, -0.1f, -5.0f}, {5.0f, 0.0f, 5.0f});
  builder.box({1.1f, 0.0f, -5.0f}, {1.2f, 0.6f, 5.0f});
  const Camera camera{
      .eye_ws = {0.0f, 1.0f, 0.0f}, .target_ws = {0.0f, 0.0f, 0.0f}, .up_ws = {0.0f, 0.0f, -1.0f}};
  expect_largest(split(scene_of(builder, camera), medium_settings(0.6f), 16), 4);
}

}  // namespace
}  // namespace alcove::sample
