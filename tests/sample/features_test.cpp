// The error of each part of the occlusion, and images of different sizes, in the built-in scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "evaluate/errors.h"
#include "evaluate/static_view.h"
#include "gpu_test.h"
#include "scene/builtin_scene.h"
#include "traced_truth.h"

namespace alcove::sample {
namespace {

class FeaturesTest : public GpuTest {
 protected:
  FrameImages draw(const OcclusionSettings& settings) {
    return draw_static(gpu(), scene_, setup_, settings).value();
  }
  TracedTruth truth_of(const FrameImages& images) const {
    return trace_truth(scene_, setup_.camera, base_.radius, images);
  }

  const Scene scene_ = builtin_scene();
  StaticSetup setup_{{240, 135, NormalSource::geometric, 12}, scene_.cameras.front()};
  const OcclusionSettings base_ = OcclusionSettings(ALCOVE_QUALITY_MEDIUM, scene_.suggested_radius);
};

TEST_F(FeaturesTest, EstimatorConnectedHasASmallerErrorThanHorizons) {
  const FrameImages images = draw(base_);
  const TracedTruth truth = truth_of(images);
  const double connected = truth.rmse(images.visibility);
  EXPECT_GT(connected, 0.01);
  OcclusionSettings horizons = base_;
  horizons.estimator = ALCOVE_ESTIMATOR_HORIZONS;
  EXPECT_GT(truth.rmse(draw(horizons).visibility), 1.02 * connected);
}

// Back faces may increase the error by 2 % in this scene; the second layer must reduce it by 10 %.
TEST_F(FeaturesTest, BackFacesHardlyIncreaseTheErrorAndASecondDepthLayerReducesTheError) {
  const FrameImages images = draw(base_);
  const TracedTruth truth = truth_of(images);
  OcclusionSettings back_faces = base_;
  back_faces.thickness_limit = ALCOVE_THICKNESS_LIMIT_BACK_FACES;
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
  backs.thickness_limit = ALCOVE_THICKNESS_LIMIT_BACK_FACES;
  OcclusionSettings layers = base_;
  layers.depth_layers = 2;
  const auto renderer = FrameRenderer::create(gpu(), scene_, setup_);
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

TEST_F(FeaturesTest, KeptGbuffersGiveTheImagesOfGbuffersThatAreDrawnAgain) {
  setup_.frames = 3;
  setup_.orbit = 0.05f;
  std::vector<Image<float>> images;
  for (const std::size_t kept_views : {1u, 3u}) {
    const auto renderer = FrameRenderer::create(gpu(), scene_, setup_, kept_views);
    ASSERT_TRUE(renderer) << renderer.error();
    for (int round = 0; round < 2; ++round) {
      const auto drawn = draw_frames(**renderer, setup_, base_);
      ASSERT_TRUE(drawn) << drawn.error();
      images.push_back(drawn->visibility);
    }
  }
  for (const Image<float>& image : images) EXPECT_EQ(image.pixels, images.front().pixels);
}

// At twice the size, the same number of steps covers twice as many pixels.
TEST_F(FeaturesTest, ImageOfTwiceTheSizeIsNearlyTheSame) {
  StaticSetup large = setup_;
  large.width *= 2;
  large.height *= 2;
  const FrameImages images = draw(base_);
  const FrameImages larger = draw_static(gpu(), scene_, large, base_).value();
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

}  // namespace
}  // namespace alcove::sample
