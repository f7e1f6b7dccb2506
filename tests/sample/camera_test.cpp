#include "scene/camera.h"

#include <gtest/gtest.h>

#include <cmath>

namespace alcove::sample {
namespace {

glm::vec3 project(const Camera& camera, const glm::vec3& point_vs) {
  const glm::vec4 clip =
      camera_matrices(camera, 160, 90).clip_from_view * glm::vec4(point_vs, 1.0f);
  return glm::vec3(clip) / clip.w;
}

Camera camera_of_kind(bool orthographic, bool reversed, float far) {
  Camera camera;
  camera.orthographic = orthographic;
  camera.reversed_z = reversed;
  camera.near_plane = 0.5f;
  camera.far_plane = far;
  return camera;
}

TEST(Camera, NearAndFarPlaneProjectToTheEndsOfTheDepthRange) {
  for (const bool orthographic : {false, true}) {
    for (const bool reversed : {false, true}) {
      const Camera camera = camera_of_kind(orthographic, reversed, 20.0f);
      EXPECT_NEAR(project(camera, {0, 0, -0.5f}).z, reversed ? 1.0f : 0.0f, 1e-6f);
      EXPECT_NEAR(project(camera, {0, 0, -20.0f}).z, reversed ? 0.0f : 1.0f, 1e-6f);
    }
  }
}

TEST(Camera, DistanceComputedFromProjectedDepthIsTheOriginalOneForEveryProjection) {
  for (const bool orthographic : {false, true}) {
    for (const bool reversed : {false, true}) {
      for (const float far : {20.0f, INFINITY}) {
        if (orthographic && std::isinf(far)) continue;
        const Camera camera = camera_of_kind(orthographic, reversed, far);
        const glm::mat4 clip = camera_matrices(camera, 160, 90).clip_from_view;
        for (const float depth : {0.6f, 3.0f, 19.0f})
          EXPECT_NEAR(view_depth(clip, project(camera, {0, 0, -depth}).z), depth, 1e-3f * depth);
      }
    }
  }
}

TEST(Camera, FarDepthValueOfAnInfiniteProjectionConvertsToInfinity) {
  for (const bool reversed : {false, true}) {
    const Camera camera = camera_of_kind(false, reversed, INFINITY);
    const glm::mat4 clip = camera_matrices(camera, 160, 90).clip_from_view;
    EXPECT_TRUE(std::isinf(view_depth(clip, reversed ? 0.0 : 1.0)));
  }
}

TEST(Camera, PointsInTheDirectionOfTheUpVectorProjectToTheTopOfTheFramebuffer) {
  EXPECT_LT(project(Camera(), {0, 1, -5}).y, 0.0f);
  EXPECT_GT(project(Camera(), {1, 0, -5}).x, 0.0f);
}

TEST(Camera, JitterGivenInPixelsMovesTheImageByThatManyPixels) {
  for (const bool orthographic : {false, true}) {
    Camera camera = camera_of_kind(orthographic, false, 50.0f);
    const glm::vec3 before = project(camera, {0.2f, 0.3f, -4});
    camera.jitter_px = {0.25f, -0.5f};
    const glm::vec3 moved = project(camera, {0.2f, 0.3f, -4}) - before;
    EXPECT_NEAR(moved.x * 80.0f, 0.25f, 1e-4f);
    EXPECT_NEAR(moved.y * 45.0f, -0.5f, 1e-4f);
  }
}

TEST(Camera, PointOnTheRayThroughAPixelProjectsBackOntoThatPixel) {
  Camera camera = camera_of_kind(false, true, INFINITY);
  camera.eye_ws = {1, 2, 3};
  camera.target_ws = {-2, 0, -1};
  camera.offset_ndc = {0.3f, -0.2f};
  for (const bool orthographic : {false, true}) {
    camera.orthographic = orthographic;
    camera.far_plane = 100.0f;
    const CameraMatrices matrices = camera_matrices(camera, 160, 90);
    const glm::vec2 pixel(31.5f, 70.5f);
    const Ray ray = camera_ray(matrices, orthographic, pixel, 160, 90);
    const glm::vec4 clip =
        matrices.clip_from_world * glm::vec4(ray.origin_ws + 7.0f * ray.direction_ws, 1.0f);
    EXPECT_NEAR((clip.x / clip.w * 0.5f + 0.5f) * 160.0f, pixel.x, 1e-3f);
    EXPECT_NEAR((clip.y / clip.w * 0.5f + 0.5f) * 90.0f, pixel.y, 1e-3f);
  }
}

TEST(Camera, CameraThatLooksAlongItsUpVectorStillHasAValidViewRotation) {
  Camera camera;
  camera.eye_ws = {0, 5, 0};
  camera.target_ws = {0, 0, 0};
  const glm::mat4 view = camera_matrices(camera, 16, 9).view_from_world;
  EXPECT_NEAR(glm::determinant(glm::mat3(view)), 1.0f, 1e-5f);
}

TEST(Camera, OrbitByZeroDegreesKeepsTheEyeExactly) {
  // The target's coordinates are so much larger than those of the eye that the eye cannot be
  // recomputed from the target and the offset in floats.
  Camera camera;
  camera.eye_ws = {1.1e-9f, 3e-9f, 6e-9f};
  camera.target_ws = {-0.5f, -0.4f, -0.8f};
  EXPECT_EQ(orbited(camera, 0.0f).eye_ws, camera.eye_ws);
}

TEST(Camera, FullOrbitReturnsTheEyeToItsStart) {
  Camera camera;
  camera.eye_ws = {3, 1, 2};
  camera.target_ws = {0, 0.5f, 0};
  Camera turned = camera;
  for (int i = 0; i < 8; ++i) turned = orbited(turned, glm::radians(45.0f));
  EXPECT_NEAR(glm::distance(turned.eye_ws, camera.eye_ws), 0.0f, 1e-5f);
}

}  // namespace
}  // namespace alcove::sample
