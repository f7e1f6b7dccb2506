// The error of each part of the occlusion, and pairs of views that should look the same, on small
// images of the built-in scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "evaluate/errors.h"
#include "evaluate/static_view.h"
#include "evaluate/weave.h"
#include "gpu_test.h"
#include "scene/builtin_scene.h"
#include "scene/shapes.h"
#include "traced_truth.h"

namespace alcove::sample {
namespace {

using passes::OcclusionSettings;
using passes::Quality;

// A floor with three rows of thin pickets and a wall behind them.
Scene fence_scene() {
  SceneBuilder b;
  b.use(b.add_material("wood", {0.6f, 0.5f, 0.4f}, 0.8f));
  b.box({-3.0f, -0.1f, -3.0f}, {3.0f, 0.0f, 3.0f});
  b.box({-3.0f, 0.0f, -1.6f}, {3.0f, 2.0f, -1.5f});
  for (int row = 0; row < 3; ++row) {
    const float z = -1.2f + 0.5f * static_cast<float>(row);
    for (int i = -20; i <= 20; ++i) {
      const float x = 0.12f * static_cast<float>(i);
      b.box({x, 0.0f, z}, {x + 0.03f, 0.8f, z + 0.015f});
    }
  }
  Scene scene = b.finish("fence");
  scene.suggested_radius = 0.4f;
  scene.cameras = {
      {.name = "fence", .eye_ws = {-1.5f, 1.1f, 2.2f}, .target_ws = {0.1f, 0.3f, -0.6f}}};
  return scene;
}

class FeaturesTest : public GpuTest {
 protected:
  static FrameImages draw(Gpu& gpu, const Scene& scene, const StaticSetup& setup,
                          const OcclusionSettings& settings) {
    auto images = draw_static(gpu, scene, setup, settings);
    EXPECT_TRUE(images) << images.error();
    return std::move(*images);
  }
  FrameImages draw(const OcclusionSettings& settings) {
    return draw(gpu(), scene_, setup_, settings);
  }
  TracedTruth truth_of(const FrameImages& images) const {
    return trace_truth(scene_, setup_.camera, base_.radius, images);
  }

  const Scene scene_ = builtin_scene();
  StaticSetup setup_{scene_.cameras.front(), 240, 135, 12, NormalSource::geometric};
  const OcclusionSettings base_ = passes::quality_settings(Quality::medium, default_radius(scene_));
};

TEST_F(FeaturesTest, SixtyFourStepsHaveNoLargerErrorThanSixteenInEveryScene) {
  for (const Scene& scene : {builtin_scene(), fence_scene()}) {
    SCOPED_TRACE(scene.name);
    const StaticSetup setup{scene.cameras.front(), 240, 135, 1, NormalSource::geometric};
    OcclusionSettings settings = passes::quality_settings(Quality::medium, scene.suggested_radius);
    settings.tile_size = 1;
    settings.slices = 8;
    settings.steps = 16;
    settings.history_frames = 0;
    const FrameImages sixteen = draw(gpu(), scene, setup, settings);
    const TracedTruth truth = trace_truth(scene, setup.camera, settings.radius, sixteen);
    settings.steps = 64;
    EXPECT_GT(truth.rmse(sixteen.visibility), 0.01);
    // A change of 1 % is within the noise of one frame at this size.
    EXPECT_LE(truth.rmse(draw(gpu(), scene, setup, settings).visibility),
              1.01 * truth.rmse(sixteen.visibility));
  }
}

TEST_F(FeaturesTest, EstimatorConnectedHasASmallerErrorThanHorizons) {
  const FrameImages images = draw(base_);
  const TracedTruth truth = truth_of(images);
  const double connected = truth.rmse(images.visibility);
  EXPECT_GT(connected, 0.01);
  OcclusionSettings horizons = base_;
  horizons.estimator = passes::Estimator::horizons;
  EXPECT_GT(truth.rmse(draw(horizons).visibility), 1.02 * connected);
}

// The noise of few traces per pixel must not form a regular pattern. The limit is an eighth of the
// weave that a lattice of directions over the whole image has here, .019.
TEST_F(FeaturesTest, FirstFramesOfAHistoryHaveNoWeave) {
  setup_.width = 480;
  setup_.height = 270;
  setup_.frames = 8;
  const FrameImages images = draw(base_);
  const TracedTruth truth = truth_of(images);
  const Weave weave = measure_weave(images.visibility, truth.visibility, truth.surfaces);
  EXPECT_GT(weave.windows, 30u);
  EXPECT_LT(weave.rms(), 0.0024);
}

// Back faces may increase the error by 2 % in this scene; the second layer must reduce it by 10 %.
TEST_F(FeaturesTest, BackFacesHardlyIncreaseTheErrorAndASecondDepthLayerReducesTheError) {
  const FrameImages images = draw(base_);
  const TracedTruth truth = truth_of(images);
  OcclusionSettings back_faces = base_;
  back_faces.thickness_unit = passes::ThicknessUnit::back_faces;
  OcclusionSettings second_layer = base_;
  second_layer.depth_layers = 2;
  const double base = truth.rmse(images.visibility);
  EXPECT_LT(0.98 * truth.rmse(draw(back_faces).visibility), base);
  EXPECT_LT(1.1 * truth.rmse(draw(second_layer).visibility), base);
}

// More steps or slices may raise the error by at most the factor kRise, relative to the smallest
// error with fewer of them. Many steps find nearly all thin occluders, each with the assumed
// thickness, so that the error does not fall with every step.
TEST_F(FeaturesTest, MoreStepsAndSlicesDoNotRaiseTheErrorByMoreThanTwoPercent) {
  constexpr double kRise = 1.02;
  setup_.frames = 4;
  std::optional<TracedTruth> truth;
  const auto error_of = [&](std::uint32_t steps, std::uint32_t slices) {
    OcclusionSettings settings = base_;
    settings.steps = steps;
    settings.slices = slices;
    const FrameImages images = draw(settings);
    if (!truth) truth = truth_of(images);
    return truth->rmse(images.visibility);
  };
  const auto check = [&](const std::vector<double>& errors) {
    double least = errors.front();
    for (const double error : errors) {
      EXPECT_LT(error, kRise * least) << testing::PrintToString(errors);
      least = std::min(least, error);
    }
  };
  check({error_of(8, 2), error_of(16, 2), error_of(32, 2), error_of(64, 2)});
  check({error_of(16, 1), error_of(16, 2), error_of(16, 4), error_of(16, 8)});
}

// One renderer alternates between settings with and without hidden depths.
TEST_F(FeaturesTest, BackFacesAndSecondDepthLayerAreRenderedIfTheSettingsNeedThem) {
  OcclusionSettings backs = base_;
  backs.thickness_unit = passes::ThicknessUnit::back_faces;
  OcclusionSettings layers = base_;
  layers.depth_layers = 2;
  const auto renderer =
      FrameRenderer::create(gpu(), scene_, {setup_.width, setup_.height}, setup_.normals);
  ASSERT_TRUE(renderer) << renderer.error();
  FrameRequest request;
  request.view = gbuffer_view(setup_.camera, setup_.camera, {setup_.width, setup_.height});
  const std::vector<OcclusionSettings> asked{base_, backs, layers};
  std::vector<Image<float>> images;
  for (const std::size_t i : {0, 1, 0, 2, 1, 2}) {
    request.occlusion = asked[i];
    const auto drawn = (*renderer)->draw_and_read(request);
    ASSERT_TRUE(drawn) << drawn.error();
    images.push_back(drawn->visibility);
  }
  EXPECT_EQ(images[0].pixels, images[2].pixels);
  EXPECT_EQ(images[1].pixels, images[4].pixels);
  EXPECT_EQ(images[3].pixels, images[5].pixels);
  EXPECT_NE(images[0].pixels, images[1].pixels);
  EXPECT_NE(images[0].pixels, images[3].pixels);
  EXPECT_NE(images[1].pixels, images[3].pixels);
}

// Depth of another range or direction describes the same surfaces.
TEST_F(FeaturesTest, ReversedAndInfiniteDepthGiveNearlyTheSameImage) {
  StaticSetup reversed = setup_;
  reversed.camera.reversed_z = true;
  StaticSetup infinite = setup_;
  infinite.camera.far_plane = INFINITY;
  const Image<float> visibility = draw(base_).visibility;
  const Mask all(setup_.width, setup_.height, 1);
  for (const StaticSetup& other : {reversed, infinite})
    EXPECT_LT(compare_images(draw(gpu(), scene_, other, base_).visibility, visibility, all).rmse,
              0.004);
}

// At twice the size, the same number of steps covers twice as many pixels.
TEST_F(FeaturesTest, ImageOfTwiceTheSizeIsNearlyTheSame) {
  StaticSetup large = setup_;
  large.width *= 2;
  large.height *= 2;
  const FrameImages images = draw(base_);
  const FrameImages larger = draw(gpu(), scene_, large, base_);
  const Image<float> depth = linear_depth(setup_.camera, images.depth_ndc);
  const Image<float> larger_depth = linear_depth(setup_.camera, larger.depth_ndc);
  Image<float> mean(setup_.width, setup_.height);
  Mask same_surface(setup_.width, setup_.height, 1);
  for (std::uint32_t y = 0; y < large.height; ++y) {
    for (std::uint32_t x = 0; x < large.width; ++x) {
      mean.at(x / 2, y / 2) += 0.25f * larger.visibility.at(x, y);
      const float here = depth.at(x / 2, y / 2);
      if (!(std::abs(larger_depth.at(x, y) - here) < 0.02f * here))
        same_surface.at(x / 2, y / 2) = 0;
    }
  }
  EXPECT_LT(compare_images(mean, images.visibility, same_surface).rmse, 0.06);  // 0.045
}

// A narrow perspective from far away is nearly an orthographic view.
TEST_F(FeaturesTest, OrthographicViewLooksAsFromFarAway) {
  constexpr float kTimes = 300.0f;  // as far as the given camera
  const glm::vec3 back = setup_.camera.eye_ws - setup_.camera.target_ws;
  const float distance = glm::length(back);
  const float further = (kTimes - 1.0f) * distance;
  StaticSetup flat = setup_;
  flat.camera.orthographic = true;
  flat.camera.ortho_height = 2.0f * distance * std::tan(0.5f * setup_.camera.fov_y);
  StaticSetup away = setup_;
  away.camera.eye_ws = setup_.camera.target_ws + back * kTimes;
  away.camera.fov_y = 2.0f * std::atan(0.5f * flat.camera.ortho_height / (kTimes * distance));
  away.camera.near_plane += further;
  away.camera.far_plane += further;
  const FrameImages images = draw(gpu(), scene_, flat, base_);
  const FrameImages others = draw(gpu(), scene_, away, base_);
  const Image<float> depth = linear_depth(flat.camera, images.depth_ndc);
  const Image<float> other = linear_depth(away.camera, others.depth_ndc);
  // Surfaces before and behind the target are shifted by some pixels.
  const float pixel = flat.camera.ortho_height / static_cast<float>(setup_.height);
  Mask same_surface(setup_.width, setup_.height);
  for (std::size_t i = 0; i < same_surface.pixels.size(); ++i)
    same_surface.pixels[i] = std::abs(other.pixels[i] - further - depth.pixels[i]) < pixel ? 1 : 0;
  const ErrorSummary difference =
      compare_images(others.visibility, images.visibility, same_surface);
  EXPECT_GT(difference.count, 4'000u);  // 4363
  EXPECT_LT(difference.rmse, 0.05);     // 0.038
}

}  // namespace
}  // namespace alcove::sample
