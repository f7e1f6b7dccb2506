// Tests that surfaces hidden by the first depth layer occlude as if they were visible.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hidden_depths.h"

namespace alcove::passes {
namespace {

class SecondDepthLayer : public HiddenDepthTest {};

OcclusionSettings exact(float radius) {
  OcclusionSettings settings = without_hidden_occlusion(radius);
  settings.thickness = 1.0f;
  return settings;
}

OcclusionSettings of_layers(OcclusionSettings settings, std::uint32_t layers) {
  settings.depth_layers = layers;
  return settings;
}

//          _______________   a plate beyond the radius, above
//
//                   _______  a step: from a point of the floor it occludes all directions that are
//   ____x__________|         lower than its edge
TEST_F(SecondDepthLayer, VisibilityBesideAStepHiddenUnderAPlateMatchesTheClosedForm) {
  const TestView view = orthographic_view("orthographic", 4.0, 4.0, 0.1, 20.0);
  const double step = 0.35, height = 0.3, floor = 4.0;
  Scene scene = box({step, -100.0, -2.0 * floor}, {100.0, 100.0, height - floor});
  scene.push_back(plane({0.0, 0.0, -floor}, {0.0, 0.0, 1.0}));
  const Scene plate = box({0.1, -100.0, -0.8}, {100.0, 100.0, -0.6});
  scene.insert(scene.end(), plate.begin(), plate.end());
  const Drawing drawing = draw(view, 128, 128, scene);
  const HostImage second = draw_second_layer(view, 128, 128, scene);
  const auto mean_error = [&](const OcclusionSettings& settings) {
    const HostImage image = visibility(drawing, second, settings);
    double sum = 0.0;
    for (std::uint32_t x = 52; x < 66; ++x) {
      const double away = step - (x + 0.5 - 64) * 8.0 / 128;
      const double truth = 1.0 - 0.5 * (1.0 - away / std::hypot(away, height));
      sum += std::abs(image.at(x, 64) - truth) / 14;
    }
    return sum;
  };
  const OcclusionSettings settings = exact(1.5f);
  const double error = mean_error(of_layers(settings, 2));
  EXPECT_LT(error, 0.02);
  EXPECT_LT(4.0 * error, mean_error(settings)) << "the first layer does not show the step";
}

// A radius within which all surfaces of the images lie. No foreground hides directions then, which
// would be excluded unless the second layer shows what lies there.
constexpr float kWideRadius = 12.0f;

Scene tilted_and_box() {
  Scene scene = box({0.31, -50.0, -20.0}, {0.6, 50.0, -3.5});
  scene.push_back(plane({0.0, 0.0, -4.0}, {0.3, 0.1, 1.0}));
  return scene;
}

// Tests second layers without a hidden surface: the sky, NaN, and a copy of the first layer, which
// has no occluders between its many samples.
TEST_F(SecondDepthLayer, SecondLayerWithoutHiddenSurfacesDoesNotChangeVisibility) {
  const Scene scene = tilted_and_box();
  for (const TestView& view : test_views()) {
    SCOPED_TRACE(view.name);
    const Drawing drawing = draw(view, 60, 40, scene);
    // Two pipelines may round differently, by one step of 16 bits.
    const auto expect_no_change = [&](const HostImage& second, float radius) {
      OcclusionSettings settings = exact(radius);
      settings.thickness = 0.2f;
      settings.hidden_occlusion = 0.4f;
      const HostImage expected = visibility(drawing, second, settings);
      settings.depth_layers = 2;
      EXPECT_THAT(visibility(drawing, second, settings).texels,
                  testing::Pointwise(testing::FloatNear(1.6e-5f), expected.texels))
          << second.texels.front();
    };
    expect_no_change(drawing.depth_ndc, 1.2f);
    HostImage second = drawing.depth_ndc;
    for (const float none : {drawing.camera.sky(), std::numeric_limits<float>::quiet_NaN()}) {
      std::ranges::fill(second.texels, none);
      expect_no_change(second, kWideRadius);
    }
  }
}

// A second layer adds occluded sectors and removes none.
TEST_F(SecondDepthLayer, SearchingASecondDepthLayerNeverRaisesVisibility) {
  Scene scene = tilted_and_box();
  scene.push_back(sphere({0.36, 0.1, -2.2}, 0.35));
  for (const TestView& view : test_views()) {
    SCOPED_TRACE(view.name);
    const Drawing drawing = draw(view, 60, 40, scene);
    const HostImage second = draw_second_layer(view, 60, 40, scene);
    const OcclusionSettings settings = exact(kWideRadius);
    const HostImage one = visibility(drawing, second, settings);
    const HostImage two = visibility(drawing, second, of_layers(settings, 2));
    double darker = 0.0;
    for (std::size_t i = 0; i < one.texels.size(); ++i) {
      EXPECT_LE(two.texels[i], one.texels[i] + 1e-4f);
      darker += one.texels[i] - two.texels[i];
    }
    EXPECT_GT(darker, 1.0);
  }
}

TEST_F(SecondDepthLayer, EstimatorHorizonsIgnoresTheSecondDepthLayer) {
  const Scene scene = tilted_and_box();
  const TestView view = test_views().front();
  const Drawing drawing = draw(view, 60, 40, scene);
  OcclusionSettings settings = exact(1.2f);
  settings.estimator = ALCOVE_ESTIMATOR_HORIZONS;
  const HostImage second = draw_second_layer(view, 60, 40, scene);
  EXPECT_EQ(visibility(drawing, second, of_layers(settings, 2)).texels,
            visibility(drawing, second, settings).texels);
}

}  // namespace
}  // namespace alcove::passes
