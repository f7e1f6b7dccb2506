// The built-in scene in motion, small: what `alcove motion` prints, held to bounds.
#include <gtest/gtest.h>

#include <cmath>

#include "evaluate/motion_run.h"
#include "gpu_test.h"
#include "scene/builtin_scene.h"

namespace alcove::sample {
namespace {

class Motion : public GpuTest {
 protected:
  static MotionSetup setup() {
    const float radius = default_radius(builtin_scene());
    return {.occlusion = passes::quality_settings(passes::Quality::medium, radius),
            .normals = NormalSource::kGeometric,
            .width = 240,
            .height = 135,
            .spp = 64};
  }
  static MotionPath path_of(MotionKind kind, std::uint32_t frames) {
    const Scene scene = builtin_scene();
    const auto rays = RayScene::create(scene);
    return {
        kind,
        motion_start(*rays, scene.cameras.front(), 16.0f / 9.0f, setup().occlusion.radius).value(),
        frames};
  }
  MotionReport run(MotionKind kind) {
    auto report = run_motion(gpu(), builtin_scene(), path_of(kind, 36), setup());
    EXPECT_TRUE(report) << report.error();
    return report.value_or(MotionReport{});
  }
};

TEST_F(Motion, FramesOfAMovingCameraAreNearlyAsGoodAsStillOnes) {
  for (const MotionKind kind : {MotionKind::kOrbit, MotionKind::kDolly, MotionKind::kStrafe}) {
    SCOPED_TRACE(name_of(kind));
    const MotionReport report = run(kind);
    EXPECT_GT(report.speed.mean, 0.2);
    EXPECT_GT(report.all.still, 0.01);
    EXPECT_LT(report.all.ratio(), 1.15);
    // Past a column much comes into view, else a line along some silhouettes.
    EXPECT_GT(report.uncovered.pixels, kind == MotionKind::kStrafe ? 500u : 50u);
    EXPECT_LT(report.uncovered.ratio(), 1.5);
    EXPECT_GT(report.bent_normals.still, glm::radians(1.0));
    EXPECT_LT(report.bent_normals.ratio(), 1.15);
    EXPECT_LT(report.flicker.ratio(), 0.5);
    EXPECT_LT(report.flicker.ratio_to_searches(), 0.1);
  }
}

TEST_F(Motion, AnObjectThatMovesLeavesTheRestAsItIs) {
  const MotionReport report = run(MotionKind::kObject);
  EXPECT_GT(report.passed_by.pixels, 500u);
  // What motion adds, of which the shade's own error is none.
  const double added =
      std::sqrt(std::pow(report.passed_by.moving, 2.0) - std::pow(report.passed_by.still, 2.0));
  EXPECT_LT(added, 0.0865) << "a shade that moves leaves no long trail";
  EXPECT_LT(report.all.ratio(), 1.15);
}

TEST_F(Motion, NothingIsLeftOfWhatWasBeforeACut) {
  const auto report = run_cut(gpu(), builtin_scene(), path_of(MotionKind::kCut, 32), setup());
  ASSERT_TRUE(report) << report.error();
  ASSERT_GE(report->after.size(), 4u);
  for (const CutErrors& errors : report->after) {
    EXPECT_LT(errors.untold, 1.1 * errors.restart) << errors.frames << " frames after";
  }
}

}  // namespace
}  // namespace alcove::sample
