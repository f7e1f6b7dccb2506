// Checks the measurements of `alcove motion` on small images of the built-in scene.
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
    const float radius = builtin_scene().suggested_radius;
    return {.occlusion = OcclusionSettings(ALCOVE_QUALITY_MEDIUM, radius),
            .view = {{240, 135, NormalSource::geometric}, {}},
            .truth = {.spp = 64, .use_cache = false}};
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

TEST_F(Motion, CameraMotionIncreasesTheErrorByLessThan15Percent) {
  for (const MotionKind kind : {MotionKind::orbit, MotionKind::dolly}) {
    SCOPED_TRACE(name_of(kind));
    const MotionReport report = run(kind);
    EXPECT_GT(report.speed, 0.2);
    EXPECT_GT(report[MotionError::all].static_camera, 0.01);
    EXPECT_LT(report[MotionError::all].ratio(), 1.15);
    EXPECT_GT(report[MotionError::uncovered].pixels, 50u);
    EXPECT_LT(report[MotionError::uncovered].ratio(), 1.5);
    EXPECT_GT(report.static_bent_normal_degrees, 1.0);
    EXPECT_LT(report.bent_normal_degrees, 1.15 * report.static_bent_normal_degrees);
    EXPECT_LT(report.flicker.ratio(), 0.5);
  }
}

TEST_F(Motion, OcclusionOfAMovingObjectLeavesNoLongTrail) {
  const MotionReport report = run(MotionKind::object);
  EXPECT_GT(report[MotionError::near_object].pixels, 500u);
  // The error that motion adds to that of the static image.
  const double added = std::sqrt(std::pow(report[MotionError::near_object].moving, 2.0) -
                                 std::pow(report[MotionError::near_object].static_camera, 2.0));
  EXPECT_LT(added, 0.0865) << "the shadow of the object leaves no long trail";
  EXPECT_LT(report[MotionError::all].ratio(), 1.15);
}

TEST_F(Motion, HistoryFromBeforeACameraCutIsRejected) {
  const auto report = run_motion(gpu(), builtin_scene(), path_of(MotionKind::cut, 32), setup());
  ASSERT_TRUE(report) << report.error();
  ASSERT_GE(report->after_cut.size(), 4u);
  for (const CutErrors& errors : report->after_cut)
    EXPECT_LT(errors.kept, 1.02 * errors.restarted) << errors.frames << " frames after";
}

}  // namespace
}  // namespace alcove::sample
