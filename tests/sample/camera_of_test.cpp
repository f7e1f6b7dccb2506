#include "cli/camera_of.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/builtin_scene.h"

namespace alcove::sample {
namespace {

using testing::HasSubstr;

TEST(CameraOf, TakesTheScenesAndThenWhatWasTyped) {
  const Scene scene = builtin_scene();
  ViewOptions view;
  view.camera = "court";
  view.fov_y = 0.5f;
  const auto camera = camera_of(view, scene);
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->eye_ws, find_camera(scene, "court")->eye_ws);
  EXPECT_EQ(camera->fov_y, 0.5f);
}

TEST(CameraOf, ACameraThatTheSceneLacksIsRefusedWithThoseItHas) {
  ViewOptions view;
  view.camera = "kitchen";
  const auto camera = camera_of(view, builtin_scene());
  ASSERT_FALSE(camera);
  EXPECT_THAT(camera.error(), HasSubstr("court"));
}

TEST(CameraOf, NamesOfCamerasCannotBeTakenForOneAnother) {
  Scene scene;
  scene.cameras = {{.name = "great hall"}, {.name = "roof"}};
  ViewOptions view;
  view.camera = "hall";
  EXPECT_EQ(camera_of(view, scene).error(),
            "the scene has no camera \"hall\"; it has \"great hall\", \"roof\"");
}

TEST(CameraOf, OfThousandsOfCamerasOnlySomeAreListed) {
  Scene scene;
  for (const char digit : {'0', '1', '2', '3', '4', '5', '6', '7', '8', '9'}) {
    scene.cameras.push_back({.name = {'c', digit}});
  }
  ViewOptions view;
  view.camera = "hall";
  EXPECT_THAT(camera_of(view, scene).error(), testing::EndsWith("\"c8\", \"c9\""));
  scene.cameras.resize(2000);
  EXPECT_EQ(camera_of(view, scene).error(),
            "the scene has no camera \"hall\"; it has \"c0\", \"c1\", \"c2\", \"c3\", \"c4\", "
            "\"c5\", \"c6\", \"c7\", \"c8\", \"c9\" and 1990 more");
}

TEST(CameraOf, AViewThatIsTypedStandsUprightWhateverTheScenesCameraCallsUp) {
  Scene scene;
  scene.cameras = {{.name = "tilted", .up_ws = {0.6f, 0.8f, 0.0f}}};
  ViewOptions view;
  EXPECT_EQ(camera_of(view, scene)->up_ws, glm::vec3(0.6f, 0.8f, 0.0f));
  view.eye_ws = glm::vec3(6.0f, 3.0f, -4.0f);
  EXPECT_EQ(camera_of(view, scene)->up_ws, glm::vec3(0, 1, 0));
  view.target_ws = glm::vec3(1, 0, -3);
  EXPECT_EQ(camera_of(view, scene)->up_ws, glm::vec3(0, 1, 0));
  view.eye_ws.reset();
  EXPECT_EQ(camera_of(view, scene)->up_ws, glm::vec3(0, 1, 0));
  view.up_ws = glm::vec3(0, 0, 1);
  EXPECT_EQ(camera_of(view, scene)->up_ws, glm::vec3(0, 0, 1));
}

TEST(CameraOf, EyeOnTheTargetIsRefused) {
  ViewOptions view;
  view.eye_ws = view.target_ws = glm::vec3(1.0f);
  EXPECT_FALSE(camera_of(view, builtin_scene()));
}

TEST(CameraOf, APerspectiveHasNoPlaneBehindItsEye) {
  Scene scene;
  scene.cameras = {{.name = "plan", .orthographic = true, .near_plane = -3.0f}};
  ViewOptions view;
  ASSERT_TRUE(camera_of(view, scene));
  view.fov_y = 1.0f;
  const auto camera = camera_of(view, scene);
  ASSERT_FALSE(camera);
  EXPECT_THAT(camera.error(), HasSubstr("--near"));
  view.near_plane = 0.5f;
  EXPECT_TRUE(camera_of(view, scene));
}

TEST(CameraOf, LengthsWhoseSquaresAreNoNumbersAreRefused) {
  ViewOptions view;
  view.eye_ws = glm::vec3(0.0f, 0.0f, 1.0f);
  view.target_ws = glm::vec3(0.0f);
  ASSERT_TRUE(camera_of(view, builtin_scene()));
  for (const float scale : {1e-30f, 1e30f}) {
    ViewOptions scaled = view;
    scaled.eye_ws = scale * *view.eye_ws;
    EXPECT_FALSE(camera_of(scaled, builtin_scene())) << scale;
    scaled = view;
    scaled.up_ws = glm::vec3(0.0f, scale, 0.0f);
    EXPECT_FALSE(camera_of(scaled, builtin_scene())) << scale;
  }
}

}  // namespace
}  // namespace alcove::sample
