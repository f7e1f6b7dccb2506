// Checks the measurements of `alcove ablate` on a small image of the built-in scene.
#include "evaluate/ablation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "evaluate/errors.h"
#include "evaluate/weave.h"
#include "gpu_test.h"
#include "scene/builtin_scene.h"
#include "scene/shapes.h"
#include "traced_truth.h"

namespace alcove::sample {
namespace {

using passes::OcclusionSettings;
using passes::Quality;

TEST(AblationVariants, EachVariantDiffersFromTheBaseSettingsAndHasAUniqueName) {
  for (const Quality quality : {Quality::low, Quality::medium, Quality::high}) {
    const OcclusionSettings base = passes::quality_settings(quality, 0.5f);
    std::set<std::string> names, parts;
    for (const Variant& variant : ablation_variants(base)) {
      EXPECT_FALSE(variant.settings == base) << variant.name;
      EXPECT_TRUE(names.insert(variant.part + variant.name).second) << variant.name;
      EXPECT_EQ(variant.settings.radius, base.radius) << variant.name;
      parts.insert(variant.part);
    }
    for (const char* part : {"estimator", "occluders", "resolution", "work", "snap_to_texels",
                             "border", "filter", "history"})
      EXPECT_TRUE(parts.contains(part)) << part;
    EXPECT_GT(names.size(), 15u);
  }
}

TEST(AblationVariants, OnlyVariantsWithHorizonEstimatorsHaveAFalloff) {
  OcclusionSettings base = passes::quality_settings(Quality::medium, 0.5f);
  base.advanced.estimator = passes::Estimator::horizons;
  base.advanced.falloff = 0.5f;
  for (const Variant& variant : ablation_variants(base)) {
    const bool has_falloff = variant.settings.advanced.estimator == passes::Estimator::horizons;
    EXPECT_EQ(variant.settings.advanced.falloff, has_falloff ? 0.5f : 0.0f) << variant.name;
  }
}

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

class AblationTest : public GpuTest {
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

TEST_F(AblationTest, SixtyFourStepsHaveNoLargerErrorThanSixteenInEveryScene) {
  for (const Scene& scene : {builtin_scene(), fence_scene()}) {
    SCOPED_TRACE(scene.name);
    const StaticSetup setup{scene.cameras.front(), 240, 135, 1, NormalSource::geometric};
    OcclusionSettings settings = passes::quality_settings(Quality::medium, scene.suggested_radius);
    settings.tile_size = 1;
    settings.slices = 8;
    settings.steps = 16;
    settings.history_frames = 0;
    settings.advanced.filter_radius = 0;
    const FrameImages sixteen = draw(gpu(), scene, setup, settings);
    const TracedTruth truth = trace_truth(scene, setup.camera, settings.radius, sixteen);
    settings.steps = 64;
    EXPECT_GT(truth.rmse(sixteen.visibility), 0.01);
    // A change of 1 % is within the noise of one frame at this size.
    EXPECT_LE(truth.rmse(draw(gpu(), scene, setup, settings).visibility),
              1.01 * truth.rmse(sixteen.visibility));
  }
}

TEST_F(AblationTest, EstimatorConnectedHasTheSmallestErrorOfAllEstimators) {
  std::vector<Variant> estimators = ablation_variants(base_);
  std::erase_if(estimators, [](const Variant& v) { return v.part != "estimator"; });
  ASSERT_GE(estimators.size(), 2u);
  Session session{scene_, setup_.camera, base_};
  session.device.validation = true;
  auto gpu = open_gpu(session.device);
  ASSERT_TRUE(gpu) << gpu.error();
  session.gpu = std::move(*gpu);
  const ChosenClock clock{Clock::processor, {}};
  const auto rows =
      measure_variants(session, setup_, {64, 1, false}, estimators, "estimators", &clock);
  ASSERT_TRUE(rows) << rows.error();
  const Measurement& connected = rows->front();
  EXPECT_GT(connected.scene.rmse, 0.01);
  EXPECT_GT(connected.time_ms, 0.0);
  for (std::size_t i = 1; i < rows->size(); ++i) {
    const Measurement& other = (*rows)[i];
    EXPECT_GT(other.scene.rmse, 1.02 * connected.scene.rmse) << other.variant.name;
    EXPECT_GT(other.time_ms, 0.0) << other.variant.name;
    EXPECT_EQ(other.cost.bytes, connected.cost.bytes) << other.variant.name;
  }
  Variant without_history{"history", "none", base_};
  without_history.settings.history_frames = 0;
  const auto less =
      measure_variants(session, setup_, {64, 1, false}, {without_history}, "history", nullptr);
  ASSERT_TRUE(less) << less.error();
  EXPECT_LT((*less)[1].cost.bytes, (*less)[0].cost.bytes / 2);
  EXPECT_EQ((*less)[1].time_ms, 0.0);
}

// The noise of few traces per pixel must not form a regular pattern. The limit is an eighth of the
// weave that a lattice of directions over the whole image has here, .019.
TEST_F(AblationTest, FirstFramesOfAHistoryHaveNoWeave) {
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
TEST_F(AblationTest, BackFacesHardlyIncreaseTheErrorAndASecondDepthLayerReducesTheError) {
  const FrameImages images = draw(base_);
  const TracedTruth truth = truth_of(images);
  OcclusionSettings back_faces = base_;
  back_faces.advanced.thickness_unit = passes::ThicknessUnit::back_faces;
  OcclusionSettings second_layer = base_;
  second_layer.depth_layers = 2;
  const double base = truth.rmse(images.visibility);
  EXPECT_LT(0.98 * truth.rmse(draw(back_faces).visibility), base);
  EXPECT_LT(1.1 * truth.rmse(draw(second_layer).visibility), base);
}

// More steps or slices may raise the error by at most the factor kRise, relative to the smallest
// error with fewer of them. Many steps find nearly all thin occluders, each with the assumed
// thickness, so that the error does not fall with every step. `alcove bench --grid` prints the
// table for any view; in larger images the error rises by 3 to 8 % up to 64 steps.
TEST_F(AblationTest, MoreStepsAndSlicesDoNotRaiseTheErrorByMoreThanTwoPercent) {
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

TEST_F(AblationTest, SnappingToTexelCentresKeepsUnoccludedSurfacesUnoccluded) {
  const FrameImages images = draw(base_);
  const auto [truth, surfaces] = truth_of(images);
  Mask open = surfaces;
  for (std::size_t i = 0; i < truth.pixels.size(); ++i)
    open.pixels[i] = surfaces.pixels[i] != 0 && truth.pixels[i] >= 1.0f ? 1 : 0;
  OcclusionSettings settings = base_;
  settings.advanced.snap_to_texels = false;
  const double with = compare_images(images.visibility, truth, open).bias;
  const double without = compare_images(draw(settings).visibility, truth, open).bias;
  EXPECT_GT(with, -0.01);
  EXPECT_LT(without, 2.0 * with - 0.003);
}

// One renderer alternates between settings with and without hidden depths.
TEST_F(AblationTest, BackFacesAndSecondDepthLayerAreRenderedIfTheSettingsNeedThem) {
  OcclusionSettings backs = base_;
  backs.advanced.thickness_unit = passes::ThicknessUnit::back_faces;
  OcclusionSettings layers = base_;
  layers.depth_layers = 2;
  const auto renderer =
      FrameRenderer::create(gpu(), scene_, {setup_.width, setup_.height}, setup_.normals);
  ASSERT_TRUE(renderer) << renderer.error();
  const CameraMatrices m = camera_matrices(setup_.camera, setup_.width, setup_.height);
  FrameRequest request;
  request.view = {m.view_from_world, m.clip_from_view, m.view_from_world, m.clip_from_view};
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

TEST_F(AblationTest, PairsOfViewsThatShouldLookEqualGiveNearlyEqualImages) {
  for (const InvariancePair& pair : invariance_pairs(setup_.camera, setup_.height)) {
    if (pair.scale != 1 || pair.further > 0.0f) continue;
    StaticSetup second = setup_;
    setup_.camera = pair.first;
    second.camera = pair.second;
    const Mask all(setup_.width, setup_.height, 1);
    EXPECT_LT(
        compare_images(draw(base_).visibility, draw(gpu(), scene_, second, base_).visibility, all)
            .rmse,
        0.004)
        << pair.name;
  }
}

}  // namespace
}  // namespace alcove::sample
