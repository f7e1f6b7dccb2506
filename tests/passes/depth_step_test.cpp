// Tests that planes stay unoccluded if the depth buffer's resolution is too coarse for their
// distance.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "drawing.h"
#include "gtao_scenes.h"
#include "pass_fixture.h"

namespace alcove::passes {
namespace {

constexpr std::uint32_t kWidth = 96;
constexpr std::uint32_t kHeight = 64;

class DepthPrecision : public PassTest {
 protected:
  // Returns the visibility of the third frame with a depth buffer of `format`.
  HostImage visibility(const Drawing& drawing, VkFormat format, OcclusionSettings settings) {
    settings.precision = ALCOVE_PRECISION_FLOAT32;
    for (std::uint32_t index = 0; index < 3; ++index) {
      run([&](framegraph::Graph& graph) {
        if (index == 0) graph.reset_histories();
        ViewTextures textures{upload(graph, drawing.depth_ndc), upload(graph, drawing.normal_vs)};
        add_view_of(graph,
                    {.camera = drawing.view,
                     .previous_camera = drawing.view,
                     .depth_format = static_cast<std::uint32_t>(format),
                     .normals_in_view_space = 1},
                    index, settings, textures);
        read_back(graph, textures[ALCOVE_IMAGE_VISIBILITY]);
      });
    }
    return result();
  }

  void expect_open(const Drawing& drawing, VkFormat format, float radius) {
    for (const AlcoveQuality quality : {ALCOVE_QUALITY_MEDIUM, ALCOVE_QUALITY_HIGH}) {
      for (const AlcoveEstimator estimator :
           {ALCOVE_ESTIMATOR_CONNECTED, ALCOVE_ESTIMATOR_HORIZONS}) {
        SCOPED_TRACE(testing::Message() << "radius " << radius << ", quality " << int(quality)
                                        << ", estimator " << int(estimator));
        OcclusionSettings settings(quality, radius);
        settings.estimator = estimator;
        const HostImage image = visibility(drawing, format, settings);
        EXPECT_GE(*std::ranges::min_element(image.texels), 0.98f);
      }
    }
  }
};

Drawing with_fixed_point_depth(Drawing drawing, double levels) {
  for (float& depth : drawing.depth_ndc.texels)
    depth = static_cast<float>(std::round(depth * levels) / levels);
  return drawing;
}

// The ground lies 60 units below the eye and is seen 500 units away with a telephoto lens.
TEST_F(DepthPrecision, DistantGroundIsUnoccludedWithFloatDepthThatIsNotReversed) {
  const double scale = 1.0 / std::tan(1.5 * std::numbers::pi / 180.0);
  const TestView view = perspective_view("", scale / 1.5, scale, 0.01, 5000.0, false);
  const double slope = std::atan2(60.0, 500.0);
  const Drawing drawing = draw(
      view, kWidth, kHeight, {plane({0.0, 0.0, -503.6}, {0.0, std::cos(slope), std::sin(slope)})});
  for (const float radius : {1.0f, 4.0f, 20.0f}) expect_open(drawing, VK_FORMAT_D32_SFLOAT, radius);
}

TEST_F(DepthPrecision, FloorFiftyUnitsAwayIsUnoccludedWith16BitDepth) {
  const TestView view = perspective_view("", 1.2, 1.8, 0.1, 1000.0, false);
  const Drawing drawing = with_fixed_point_depth(
      draw(view, kWidth, kHeight, {plane({0.0, 0.0, -50.0}, {0.0, 0.8, 0.6})}), 65535.0);
  for (const float radius : {0.5f, 2.0f, 8.0f}) expect_open(drawing, VK_FORMAT_D16_UNORM, radius);
}

TEST_F(DepthPrecision, FloorIsUnoccludedInADeepOrthographicViewWithReversedDepth) {
  for (const auto& [near, far] : {std::pair(0.1, 1e6), {-1e6, 100.0}, {-1e7, 100.0}}) {
    SCOPED_TRACE(near);
    TestView view = orthographic_view("", 6.0, 4.0, near, far);
    view.view.clip_from_view[10] = -view.view.clip_from_view[10];
    view.view.clip_from_view[14] = static_cast<float>(far / (far - near));
    const Drawing drawing =
        draw(view, kWidth, kHeight, {plane({0.0, 0.0, -20.0}, {0.0, 0.7, 0.7})});
    for (const float radius : {0.5f, 2.0f}) expect_open(drawing, VK_FORMAT_D32_SFLOAT, radius);
  }
}

// The tolerance must not remove occlusion that the depth buffer resolves.
TEST_F(DepthPrecision, GrooveKeepsItsOcclusionWith16BitDepth) {
  const TestView view = perspective_view("", 1.2, 1.8, 0.1, 100.0, false);
  const Drawing exact = draw(view, kWidth, kHeight, groove(0.8));
  const OcclusionSettings settings(ALCOVE_QUALITY_HIGH, 0.5f);
  const HostImage expected = visibility(exact, VK_FORMAT_D32_SFLOAT, settings);
  const HostImage found =
      visibility(with_fixed_point_depth(exact, 65535.0), VK_FORMAT_D16_UNORM, settings);
  EXPECT_LT(rms(found, expected), 0.02);
  EXPECT_LT(*std::ranges::min_element(found.texels), 0.75f);
}

}  // namespace
}  // namespace alcove::passes
