#include "evaluate/motion_errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace alcove::sample {
namespace {

constexpr std::uint32_t kWidth = 40;
constexpr std::uint32_t kHeight = 30;

// A wall at z = -10 and, where x is below `edge`, a nearer wall at z = -4, both facing the eye. The
// visibility is a function of the position on the wall.
RenderedFrame walls(const Camera& camera, float edge) {
  RenderedFrame frame{
      camera, {kWidth, kHeight}, {kWidth, kHeight, glm::vec3(0, 0, 1)}, {kWidth, kHeight}};
  const CameraMatrices matrices = camera_matrices(camera, kWidth, kHeight);
  const glm::vec3 forward = -glm::vec3(matrices.world_from_view[2]);
  for (std::uint32_t y = 0; y < kHeight; ++y) {
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      const Ray ray =
          camera_ray(matrices, camera.orthographic,
                     {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}, kWidth, kHeight);
      const auto at = [&](float z) {
        return ray.origin_ws + ray.direction_ws * ((z - ray.origin_ws.z) / ray.direction_ws.z);
      };
      const bool near = at(-4.0f).x < edge;
      const glm::vec3 point = at(near ? -4.0f : -10.0f);
      frame.depth.at(x, y) = glm::dot(point - camera.eye_ws, forward);
      frame.visibility.at(x, y) = 0.5f + 0.03f * point.x + 0.02f * point.y;
    }
  }
  return frame;
}

Camera camera_at(float x) {
  Camera camera;
  camera.eye_ws = {x, 0, 0};
  camera.target_ws = {x, 0, -1};
  return camera;
}

glm::vec3 unmoved(const glm::vec3& position) { return position; }

TEST(MotionErrors, StaticSurfaceIsReprojectedCorrectlyAfterAnyCameraStep) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> step(-0.5f, 0.5f);
  for (int i = 0; i < 20; ++i) {
    Camera moved = camera_at(step(random));
    moved.target_ws += glm::vec3{0.2f * step(random), 0.2f * step(random), 0.0f};
    const RenderedFrame before = walls(camera_at(0.0f), -100.0f);
    const RenderedFrame now = walls(moved, -100.0f);
    const Reprojection reprojection = reproject(now, before, unmoved);
    const RunningMean change = visibility_change(now.visibility, before.visibility, reprojection);
    EXPECT_GT(change.count, 0.5 * kWidth * kHeight);
    EXPECT_LT(change.mean(), 1e-4)
        << "bilinear reading of a linear function is exact up to perspective";
  }
}

TEST(MotionErrors, SurfacesThatWereHiddenOrOutsideTheImageHaveNoTexelsBefore) {
  // The camera moves to the right, so that the near wall leaves to the left and uncovers a stripe
  // of the far one.
  const RenderedFrame before = walls(camera_at(0.0f), 0.0f);
  const float step = 0.8f;
  const RenderedFrame now = walls(camera_at(step), 0.0f);
  const Reprojection reprojection = reproject(now, before, unmoved);
  // The length in pixels of one unit of the scene at distance 1.
  const float unit = 0.5f * kHeight / std::tan(0.5f * before.camera.fov_y);
  const float near_edge = 0.5f * kWidth - step * unit / 4.0f;
  const float stripe = step * unit * (1.0f / 4.0f - 1.0f / 10.0f);
  const auto y = kHeight / 2;
  const auto x = static_cast<std::uint32_t>(near_edge + 0.5f * stripe);
  EXPECT_EQ(reprojection.texels.at(x, y), 0u) << "it was hidden";
  EXPECT_EQ(reprojection.texels.at(kWidth - 1, y), 0u) << "it was outside the image";
  EXPECT_EQ(reprojection.texels.at(kWidth / 2 + 5, y), kAllTexels);
  EXPECT_EQ(reprojection.texels.at(1, y), kAllTexels);
}

TEST(MotionErrors, MovingSurfaceIsReprojectedFromItsPreviousPosition) {
  const RenderedFrame before = walls(camera_at(0.0f), -100.0f);
  RenderedFrame now = before;
  // The wall moved to the right by a unit, and its visibility with it.
  for (float& visibility : now.visibility.pixels) visibility -= 0.03f;
  const auto wall_before = [](const glm::vec3& position) { return position - glm::vec3(1, 0, 0); };
  const auto change = [&](const PositionBefore& position_before) {
    const Reprojection reprojection = reproject(now, before, position_before);
    return visibility_change(now.visibility, before.visibility, reprojection).mean();
  };
  EXPECT_LT(change(wall_before), 1e-5);
  EXPECT_NEAR(change(unmoved), 0.03, 1e-5);
}

TEST(MotionErrors, SkyPixelsHaveNoTexelsNoVisibilityChangeAndNoSpeed) {
  RenderedFrame sky = walls(camera_at(0.0f), -100.0f);
  std::ranges::fill(sky.depth.pixels, std::numeric_limits<float>::infinity());
  const Reprojection reprojection = reproject(sky, sky, unmoved);
  EXPECT_EQ(reprojection.texels.at(2, 2), 0u);
  EXPECT_EQ(visibility_change(sky.visibility, sky.visibility, reprojection).count, 0u);
  EXPECT_EQ(measure_speed(reprojection).count, 0u);
}

TEST(MotionErrors, ImageMotionIsMeasuredInPixelsPerFrame) {
  const RenderedFrame before = walls(camera_at(0.0f), -100.0f);
  const RenderedFrame now = walls(camera_at(0.5f), -100.0f);
  const float expected = 0.5f * 0.5f * kHeight / std::tan(0.5f * now.camera.fov_y) / 10.0f;
  EXPECT_NEAR(measure_speed(reproject(now, before, unmoved)).mean(), expected, 1e-3);
}

}  // namespace
}  // namespace alcove::sample
