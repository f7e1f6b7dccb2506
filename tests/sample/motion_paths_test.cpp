#include "evaluate/motion_paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/builtin_scene.h"

namespace alcove::sample {
namespace {

constexpr std::uint32_t kFrames = 48;

MotionStart builtin_start() {
  static const MotionStart start = [] {
    const Scene scene = builtin_scene();
    const auto rays = RayScene::create(scene);
    return motion_start(*rays, scene.cameras.front(), 16.0f / 9.0f, 0.5f).value();
  }();
  return start;
}

// The image position of a world-space point, in image heights from the middle.
glm::vec2 on_image(const Camera& camera, const glm::vec3& position) {
  const CameraMatrices matrices = camera_matrices(camera, 100, 100);
  const glm::vec4 clip = matrices.clip_from_world * glm::vec4(position, 1.0f);
  return 0.5f * glm::vec2(clip) / clip.w;
}

TEST(MotionPaths, EveryCameraPathBeginsWithTheGivenView) {
  const MotionStart start = builtin_start();
  const glm::vec3 ahead = glm::normalize(start.camera.target_ws - start.camera.eye_ws);
  for (const MotionKind kind : kMotionKinds) {
    SCOPED_TRACE(name_of(kind));
    const Camera first = MotionPath(kind, start, kFrames).camera(0);
    EXPECT_EQ(first.eye_ws, start.camera.eye_ws);
    EXPECT_LT(glm::distance(glm::normalize(first.target_ws - first.eye_ws), ahead), 1e-5f);
  }
}

TEST(MotionPaths, BlockIsCompleteInTinyScenes) {
  const auto triangles_at = [](float scale) {
    MotionStart start = builtin_start();
    for (glm::vec3* position : {&start.camera.eye_ws, &start.camera.target_ws, &start.ground_ws})
      *position *= scale;
    start.depth *= scale;
    start.radius *= scale;
    Scene scene;
    MotionPath(MotionKind::object, start, kFrames).add_to(scene);
    return triangle_count(scene);
  };
  EXPECT_GT(triangles_at(1.0f), 0u);
  // This is the size of a model of a grain of sand in metres.
  EXPECT_EQ(triangles_at(1e-5f), triangles_at(1.0f));
}

TEST(MotionPaths, CameraStepsAreSmallExceptAtTheCut) {
  const MotionStart start = builtin_start();
  for (const MotionKind kind : kMotionKinds) {
    SCOPED_TRACE(name_of(kind));
    const MotionPath path(kind, start, kFrames);
    EXPECT_EQ(path.cut().has_value(), kind == MotionKind::cut);
    for (std::uint32_t frame = 1; frame < kFrames; ++frame) {
      const float step =
          glm::distance(path.camera(frame).eye_ws, path.camera(frame - 1).eye_ws) / start.depth;
      if (path.cut() == frame)
        EXPECT_GT(step, 0.1f);
      else
        EXPECT_LT(step, 0.01f) << frame;
    }
  }
}

TEST(MotionPaths, OrbitingCameraKeepsItsDistanceToTheMiddleOfTheView) {
  const MotionStart start = builtin_start();
  const MotionPath path(MotionKind::orbit, start, kFrames);
  const Camera first = path.camera(0);
  const Camera last = path.camera(kFrames - 1);
  EXPECT_LT(glm::distance(first.target_ws, last.target_ws), 1e-5f);
  EXPECT_NEAR(glm::distance(last.eye_ws, last.target_ws), start.depth, 1e-3f * start.depth);
  EXPECT_GT(glm::distance(first.eye_ws, last.eye_ws), 0.1f * start.depth);
}

TEST(MotionPaths, MovingBlockStaysAboveTheGroundWithoutTouchingIt) {
  const MotionStart start = builtin_start();
  const MotionPath path(MotionKind::object, start, kFrames);
  Scene scene = builtin_scene();
  path.add_to(scene);
  EXPECT_TRUE(scene.meshes.back().moves);
  glm::vec2 last(0.0f);
  for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
    path.pose(scene, frame);
    float least = 1e9f;
    for (const glm::vec3& position : scene.meshes.back().positions)
      least = std::min(least, glm::dot(position - start.ground_ws, start.ground_normal_ws));
    EXPECT_NEAR(least, 0.2f * start.radius, 1e-4f);
    const glm::vec2 here =
        on_image(path.camera(frame), glm::vec3(path.world_from_moving(frame)[3]));
    if (frame > 0) {
      EXPECT_GT(here.x, last.x + 0.001f);
    }
    last = here;
  }
}

TEST(MotionPaths, OnlyPointsOfTheMovingBlockHaveAnotherPreviousPosition) {
  const MotionPath path(MotionKind::object, builtin_start(), kFrames);
  Scene then = builtin_scene();
  path.add_to(then);
  Scene now = then;
  path.pose(then, 6);
  path.pose(now, 7);
  for (std::size_t i = 0; i < now.meshes.back().positions.size(); ++i) {
    const glm::vec3 found = path.position_before(now.meshes.back().positions[i], 7);
    EXPECT_LT(glm::distance(found, then.meshes.back().positions[i]), 1e-4f);
    EXPECT_TRUE(path.is_near_object(now.meshes.back().positions[i], 7, 0));
  }
  const glm::vec3 far = builtin_start().camera.eye_ws;
  EXPECT_EQ(path.position_before(far, 7), far);
  EXPECT_FALSE(path.is_near_object(far, 7, 6));
  // A place that the block has left still counts as near it for the given number of frames.
  const glm::vec3 left(path.world_from_moving(0)[3]);
  EXPECT_TRUE(path.is_near_object(left, kFrames - 1, kFrames - 1));
}

TEST(MotionPaths, CameraPathFromAViewWithoutSurfacesIsRefused) {
  const Scene scene = builtin_scene();
  const auto rays = RayScene::create(scene);
  ASSERT_TRUE(rays);
  Camera away = scene.cameras.front();
  away.eye_ws = scene.bounds_ws.high + glm::vec3(10.0f);
  away.target_ws = away.eye_ws + glm::vec3(1.0f, 1.0f, 0.0f);
  const auto start = motion_start(*rays, away, 1.5f, 0.5f);
  ASSERT_FALSE(start);
  EXPECT_THAT(start.error(), testing::HasSubstr("--eye"));
}

}  // namespace
}  // namespace alcove::sample
