// Tests changes that must not change the image: the unit of length, the kind of projection, the
// tile size on an open plane, and NaN at other pixels.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "gtao_scenes.h"
#include "pass_fixture.h"

namespace alcove::passes {
namespace {

constexpr std::uint32_t kWidth = 57;
constexpr std::uint32_t kHeight = 39;

class GtaoInvariance : public PassTest {
 protected:
  // Returns the visibility of a scene in an image of kWidth x kHeight pixels.
  HostImage visibility(const TestView& view, const Scene& scene,
                       const OcclusionSettings& settings) {
    return render(draw(view, kWidth, kHeight, scene), settings).visibility;
  }
};

// Returns settings with so many slices that there is no filter.
OcclusionSettings unfiltered(AlcoveEstimator estimator, float radius) {
  OcclusionSettings settings;
  settings.radius = radius;
  settings.tile_size = 1;
  settings.slices = 8;
  settings.steps = 8;
  settings.estimator = estimator;
  settings.history_frames = 0;
  settings.precision = ALCOVE_PRECISION_FLOAT32;
  return settings;
}

constexpr std::array kEstimators{ALCOVE_ESTIMATOR_HORIZONS, ALCOVE_ESTIMATOR_CONNECTED};

struct Difference {
  double mean = 0.0;
  double largest = 0.0;
};

Difference difference(const HostImage& a, const HostImage& b) {
  Difference result;
  for (std::size_t i = 0; i < a.texels.size(); ++i) {
    const double apart = std::abs(a.texels[i] - b.texels[i]);
    result.mean += apart / static_cast<double>(a.texels.size());
    result.largest = std::max(result.largest, std::isfinite(apart) ? apart : 1e9);
  }
  return result;
}

TEST_F(GtaoInvariance, StandardReversedAndInfiniteDepthBuffersGiveTheSameVisibility) {
  for (const AlcoveEstimator estimator : kEstimators) {
    for (const NamedScene& scene : gtao_scenes()) {
      const TestView reversed = perspective_view("", 1.2, 1.8, 0.5, kInfinity, true);
      const HostImage expected = visibility(reversed, scene.scene, unfiltered(estimator, 1.0f));
      for (const TestView& view :
           {perspective_view("reversed finite", 1.2, 1.8, 0.5, 50.0, true),
            perspective_view("standard finite", 1.2, 1.8, 0.5, 50.0, false),
            perspective_view("standard infinite", 1.2, 1.8, 0.5, kInfinity, false)}) {
        SCOPED_TRACE(testing::Message() << scene.name << ", " << view.name);
        const Difference apart =
            difference(visibility(view, scene.scene, unfiltered(estimator, 1.0f)), expected);
        EXPECT_LT(apart.mean, 1e-3);
        EXPECT_LT(apart.largest, 0.1);
      }
    }
  }
}

TEST_F(GtaoInvariance, OrthographicViewGivesTheVisibilityOfANarrowPerspectiveFromAfar) {
  const double away = 2000.0;
  const TestView flat = orthographic_view("orthographic", 3.0, 2.0, 0.1, 20.0);
  const TestView narrow =
      perspective_view("narrow", (away + 4.0) / 3.0, (away + 4.0) / 2.0, away, kInfinity, true);
  for (const AlcoveEstimator estimator : kEstimators) {
    for (const NamedScene& scene : gtao_scenes()) {
      SCOPED_TRACE(scene.name);
      const Scene moved = transform(scene.scene, 1.0, {0.0, 0.0, -away});
      const OcclusionSettings settings = unfiltered(estimator, 1.0f);
      const Difference apart =
          difference(visibility(flat, scene.scene, settings), visibility(narrow, moved, settings));
      EXPECT_LT(apart.mean, 0.004);
    }
  }
}

// The sizes are not multiples of the tile size, so that the border cuts tiles, and the highest
// image has several strips of groups, of which the last is not full. Every pixel must be written.
TEST_F(GtaoInvariance, EveryPixelIsWrittenForAnyImageSizeAndTileSize) {
  const TestView view = test_views()[2];
  for (const auto& [width, height] :
       {std::pair{1u, 1u}, {3u, 5u}, {17u, 9u}, {33u, 1u}, {5u, 400u}}) {
    const Drawing drawing = draw(view, width, height, {tilted_plane(40.0, 4.0)});
    for (const std::uint32_t tile_size : {1u, 2u, 4u}) {
      for (const std::uint32_t history : {0u, 8u}) {
        SCOPED_TRACE(testing::Message() << width << " x " << height << " by " << tile_size
                                        << ", history of " << history);
        OcclusionSettings settings = unfiltered(ALCOVE_ESTIMATOR_CONNECTED, 0.5f);
        settings.slices = 1;
        settings.steps = 6;
        settings.tile_size = tile_size;
        settings.history_frames = history;
        settings.bent_normal = true;
        poison_memory(width, height);
        // In this frame the traced pixels of the last tiles lie outside the image.
        const HostOutputs images = run_occlusion(make_view(drawing, settings), 1);
        for (std::uint32_t i = 0; i < width * height; ++i) {
          ASSERT_NEAR(images.visibility.texels[i], 1.0, 0.05) << "pixel " << i;
          double dot = 0.0;
          for (std::uint32_t c = 0; c < 3; ++c)
            dot += images.bent_normal.texels[i * 4 + c] * drawing.normal_vs.texels[i * 4 + c];
          // With a single slice the bent normal is only known to lie above the surface.
          ASSERT_GT(dot, 0.0) << "pixel " << i;
        }
      }
    }
  }
}

TEST_F(GtaoInvariance, AllTileSizesGiveTheSameMeanVisibilityInAGroove) {
  const TestView view = test_views()[2];
  const Drawing drawing = draw(view, 64, 48, groove(0.8));
  for (const AlcoveEstimator estimator : kEstimators) {
    std::vector<double> means;
    for (const std::uint32_t tile_size : {1u, 2u, 4u}) {
      OcclusionSettings settings = unfiltered(estimator, 1.0f);
      settings.tile_size = tile_size;
      means.push_back(mean(render(drawing, settings).visibility));
    }
    EXPECT_THAT(means, testing::Each(testing::DoubleNear(means[0], 0.02)));
    EXPECT_LT(means[0], 0.98);
  }
}

TEST_F(GtaoInvariance, PixelWithNaNDepthAffectsOnlyNearbyPixelsAndGivesFiniteResults) {
  const TestView view = test_views()[2];
  for (const AlcoveEstimator estimator : kEstimators) {
    OcclusionSettings settings = unfiltered(estimator, 0.5f);
    settings.bent_normal = true;
    settings.slices = 4;  // with a filter
    Drawing drawing = draw(view, kWidth, kHeight, groove(0.8));
    HostView frame = make_view(drawing, settings);
    const HostImage clean = run_occlusion(frame).visibility;
    for (const std::uint32_t hole : {0u, 20u * kWidth + 28u}) frame.depth_ndc.texels[hole] = kNaN;
    const HostOutputs invalid = run_occlusion(frame);
    EXPECT_THAT(invalid.visibility.texels,
                testing::Each(testing::AllOf(testing::Ge(0.0f), testing::Le(1.0f))));
    for (const float component : invalid.bent_normal.texels) ASSERT_TRUE(std::isfinite(component));
    int changes = 0;
    for (std::size_t i = 0; i < clean.texels.size(); ++i)
      changes += std::abs(clean.texels[i] - invalid.visibility.texels[i]) > 0.1f ? 1 : 0;
    EXPECT_LT(changes, 40) << "of " << clean.texels.size() << " pixels";
  }
}

TEST_F(GtaoInvariance, InvalidDepthBuffersGiveFiniteImages) {
  for (const TestView& view : test_views()) {
    SCOPED_TRACE(view.name);
    Drawing drawing = draw(view, kWidth, kHeight, groove(0.8));
    const std::array nonsense{kNaN,
                              0.0f,
                              1.0f,
                              -1.0f,
                              2.0f,
                              1e-38f,
                              0.99999994f,
                              0.5f,
                              static_cast<float>(kInfinity),
                              -static_cast<float>(kInfinity)};
    HostImage backs = drawing.depth_ndc;
    for (std::size_t i = 0; i < drawing.depth_ndc.texels.size(); ++i) {
      drawing.depth_ndc.texels[i] = nonsense[(i * 2654435761u >> 7) % nonsense.size()];
      backs.texels[i] = nonsense[(i * 2246822519u >> 9) % nonsense.size()];
    }
    for (const AlcoveEstimator estimator : kEstimators) {
      for (const bool all_inputs : {false, true}) {
        OcclusionSettings settings = unfiltered(estimator, 0.5f);
        settings.bent_normal = true;
        settings.slices = 4;  // with a filter
        settings.history_frames = 8;
        settings.thickness_limit =
            all_inputs ? ALCOVE_THICKNESS_LIMIT_BACK_FACES : ALCOVE_THICKNESS_LIMIT_RADIUS;
        settings.depth_layers = all_inputs ? 2 : 1;
        for (int frame = 0; frame < 2; ++frame) {
          HostView invalid = make_view(drawing, settings);
          if (!all_inputs) invalid.normals = {};
          invalid.back_depth_ndc = invalid.second_depth_ndc = backs;
          invalid.reset = false;
          const HostOutputs images = run_occlusion(invalid);
          EXPECT_THAT(images.visibility.texels,
                      testing::Each(testing::AllOf(testing::Ge(0.0f), testing::Le(1.0f))));
          for (const float component : images.bent_normal.texels)
            ASSERT_TRUE(std::isfinite(component));
        }
      }
    }
  }
}

// The noise depends only on the pixel and the frame number. Pixels that show the same to both eyes
// must get the same values.
TEST_F(GtaoInvariance, BothEyesOfAStereoFrameGetTheSameNoise) {
  const TestView view = test_views().front();
  const Drawing drawing = draw(view, kWidth, kHeight, gtao_scenes().front().scene);
  OcclusionSettings settings(ALCOVE_QUALITY_MEDIUM, 0.5f);
  for (std::uint32_t index = 0; index < 4; ++index) {
    run([&](framegraph::Graph& graph) {
      const ViewTextures inputs{upload(graph, drawing.depth_ndc), upload(graph, drawing.normal_vs)};
      for (const std::uint32_t eye : {0u, 1u}) {
        ViewTextures textures = inputs;
        add_view_of(graph,
                    {.id = eye,
                     .camera = view.view,
                     .previous_camera = view.view,
                     .normals_in_view_space = 1},
                    index, settings, textures);
        read_back(graph, textures[ALCOVE_IMAGE_VISIBILITY]);
      }
    });
    EXPECT_EQ(result(0).texels, result(1).texels);
  }
}

TEST_F(GtaoInvariance, SkyIsUnoccludedAndDoesNotOcclude) {
  for (const TestView& view : test_views()) {
    SCOPED_TRACE(view.name);
    Shape post = plane({0.0, 0.0, -4.0}, {0.0, 0.0, 1.0});
    post.keep = [](const glm::dvec3& p) { return std::abs(p.x) < 0.8; };
    for (const AlcoveEstimator estimator : kEstimators) {
      EXPECT_THAT(
          visibility(view, {post}, unfiltered(estimator, 1.0f)).texels,
          testing::Each(testing::Ge(estimator == ALCOVE_ESTIMATOR_CONNECTED ? 0.97f : 0.996f)));
    }
  }
}

}  // namespace
}  // namespace alcove::passes
