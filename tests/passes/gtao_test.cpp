#include <gmock/gmock.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "pass_fixture.h"
#include "views.h"

namespace alcove::passes {
namespace {

using framegraph::Graph;

using Gtao = PassTest;

OcclusionSettings precise(Estimator estimator) {
  OcclusionSettings settings = quality_settings(Quality::medium, 0.5f);
  settings.estimator = estimator;
  settings.precision = Precision::float32;
  return settings;
}

TEST_F(Gtao, OpenPlaneIsFullyVisibleAtAnyTilt) {
  for (const TestView& view : test_views()) {
    for (const float degrees : {0.0f, 30.0f, 60.0f, 75.0f, 85.0f}) {
      const PlaneScene plane = plane_scene(view, 96, 64, degrees);
      for (const Estimator estimator : {Estimator::horizons, Estimator::bitmask}) {
        SCOPED_TRACE(testing::Message()
                     << view.name << " tilted " << degrees << " degrees, "
                     << (estimator == Estimator::bitmask ? "bitmask" : "horizons"));
        run([&](Graph& graph) {
          const Frame frame{graph, gpu().kernels(), view.view, 0};
          const auto outputs = add_occlusion(
              frame, {upload(graph, plane.depth_ndc), upload(graph, plane.normal_vs), true},
              precise(estimator));
          ASSERT_TRUE(outputs) << outputs.error().message;
          read_back(graph, outputs->visibility);
        });
        float lowest = 1.0f;
        for (const float visibility : result().texels) {
          lowest = std::min(lowest, visibility);
        }
        EXPECT_GE(lowest, 1.0f - 1.0f / 255.0f);
      }
    }
  }
}

}  // namespace
}  // namespace alcove::passes
