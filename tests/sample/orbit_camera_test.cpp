#include "viewer/orbit_camera.h"

#include <gtest/gtest.h>

#include <random>

namespace alcove::sample {
namespace {

constexpr std::uint32_t kSize = 100;

Camera some_camera() {
  Camera camera;
  camera.eye_ws = {1.0f, 2.0f, 5.0f};
  camera.target_ws = {0.5f, 1.0f, -1.0f};
  return camera;
}

float arm(const Camera& camera) { return glm::distance(camera.eye_ws, camera.target_ws); }

// Returns the position of a point in the image, from -1 to 1, y down.
glm::vec2 ndc(const Camera& camera, const glm::vec3& point_ws) {
  const glm::vec4 clip =
      camera_matrices(camera, kSize, kSize).clip_from_world * glm::vec4(point_ws, 1.0f);
  return glm::vec2(clip) / clip.w;
}

TEST(OrbitCamera, OrbitingKeepsTheTargetAndTheDistanceOfTheCamera) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> angle(-3.0f, 3.0f);
  Camera camera = some_camera();
  const float distance = arm(camera);
  for (int i = 0; i < 1000; ++i) {
    camera = turned(camera, {angle(random), angle(random)});
    ASSERT_EQ(camera.target_ws, some_camera().target_ws);
    ASSERT_NEAR(arm(camera), distance, 1e-2f);
    ASSERT_GT(glm::length(
                  glm::cross(glm::normalize(camera.eye_ws - camera.target_ws), glm::vec3(0, 1, 0))),
              0.01f);
  }
}

TEST(OrbitCamera, SceneRotatesInTheDirectionOfTheMouse) {
  const Camera camera = some_camera();
  const glm::vec3 towards_eye =
      camera.target_ws + 0.1f * glm::normalize(camera.eye_ws - camera.target_ws);
  EXPECT_GT(ndc(turned(camera, {0.1f, 0.0f}), towards_eye).x, 0.0f);
  EXPECT_GT(ndc(turned(camera, {0.0f, 0.1f}), towards_eye).y, 0.0f);
}

TEST(OrbitCamera, OrbitingAndOrbitingBackRestoresTheView) {
  const Camera camera = some_camera();
  const Camera back = turned(turned(camera, {0.7f, 0.2f}), {-0.7f, -0.2f});
  EXPECT_LT(glm::distance(back.eye_ws, camera.eye_ws), 1e-4f);
}

TEST(OrbitCamera, PanningMovesTheTargetWithTheMouse) {
  for (const bool orthographic : {false, true}) {
    Camera camera = some_camera();
    camera.orthographic = orthographic;
    const glm::vec2 share(0.1f, -0.2f);
    const Camera moved = panned(camera, share);
    // NDC span 2 over the height of the image, so a share of the height is twice as much in NDC.
    EXPECT_LT(glm::distance(ndc(moved, camera.target_ws), 2.0f * share), 1e-4f);
    EXPECT_LT(glm::distance(moved.eye_ws - moved.target_ws, camera.eye_ws - camera.target_ws),
              1e-5f);
  }
}

TEST(OrbitCamera, DollyingScalesTheDistanceToTheTargetAndNeverReachesTheTarget) {
  Camera camera = some_camera();
  EXPECT_NEAR(arm(dollied(camera, 0.5f)), 0.5f * arm(camera), 1e-5f);
  for (int i = 0; i < 1000; ++i) camera = dollied(camera, 0.5f);
  EXPECT_GT(arm(camera), camera.near_plane);
  camera.orthographic = true;
  EXPECT_FLOAT_EQ(dollied(camera, 2.0f).ortho_height, 2.0f * camera.ortho_height);
}

}  // namespace
}  // namespace alcove::sample
