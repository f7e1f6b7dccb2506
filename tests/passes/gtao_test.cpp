#include <gmock/gmock.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "pass_fixture.h"
#include "views.h"

namespace alcove::passes {
namespace {

using framegraph::Graph;

using GtaoPass = PassTest;

struct Preset {
  const char* name;
  Quality quality;
};
constexpr Preset kPresets[] = {{"console", Quality::console},
                               {"low", Quality::low},
                               {"medium", Quality::medium},
                               {"high", Quality::high},
                               {"reference", Quality::reference}};

OcclusionSettings precise(Quality quality) {
  OcclusionSettings settings = quality_settings(quality, 0.5f);
  settings.precision = Precision::float32;
  return settings;
}

TEST_F(GtaoPass, UnoccludedPlaneHasVisibilityOneAtAnyTilt) {
  for (const TestView& view : test_views()) {
    for (const float degrees : {0.0f, 30.0f, 60.0f, 75.0f, 85.0f}) {
      const PlaneScene plane = plane_scene(view, 96, 64, degrees);
      for (const Preset& preset : kPresets) {
        SCOPED_TRACE(testing::Message()
                     << view.name << " tilted " << degrees << " degrees, " << preset.name);
        const std::uint32_t frames = preset.quality == Quality::reference ? 1 : 4;
        for (std::uint32_t index = 0; index < frames; ++index) {
          run([&](Graph& graph) {
            if (index == 0) graph.reset_histories();
            const Frame frame{graph, gpu().kernels(), view.view, index};
            const auto outputs = add_occlusion(frame,
                                               {.depth_ndc = upload(graph, plane.depth_ndc),
                                                .normals = upload(graph, plane.normal_vs),
                                                .normal_convention = {.in_view_space = true}},
                                               precise(preset.quality));
            ASSERT_TRUE(outputs) << outputs.error().message;
            read_back(graph, outputs->visibility);
          });
          const auto& texels = result().texels;
          EXPECT_GE(*std::min_element(texels.begin(), texels.end()), 1.0f - 1.0f / 255.0f)
              << "in frame " << index;
        }
      }
    }
  }
}

// Tests the setting snap_to_texels: without it, tilted planes occlude themselves.
TEST_F(GtaoPass, TiltedPlaneOccludesItselfIfSamplesAreNotSnappedToTexelCentres) {
  const TestView view = test_views()[2];
  for (const Estimator estimator : {Estimator::horizons, Estimator::connected}) {
    OcclusionSettings settings = precise(Quality::medium);
    settings.advanced.estimator = estimator;
    for (const float degrees : {60.0f, 75.0f}) {
      SCOPED_TRACE(testing::Message() << "tilted " << degrees << " degrees");
      const PlaneScene plane = plane_scene(view, 96, 64, degrees);
      double lowest[2];
      for (const bool snap_to_texels : {false, true}) {
        settings.advanced.snap_to_texels = snap_to_texels;
        const HostImage visibility = run_occlusion({.view = view.view,
                                                    .depth_ndc = plane.depth_ndc,
                                                    .normal_vs = &plane.normal_vs,
                                                    .reset = true},
                                                   settings)
                                         .visibility;
        lowest[snap_to_texels ? 1 : 0] = *std::ranges::min_element(visibility.texels);
      }
      EXPECT_LT(lowest[0], 0.98);
      EXPECT_GE(lowest[1], 1.0 - 1.0 / 255.0);
    }
  }
}

}  // namespace
}  // namespace alcove::passes
