#include "cli/choose_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/builtin_scene.h"

namespace alcove::sample {
namespace {

using testing::HasSubstr;

Result<Camera> choose(const ViewOptions& view, const Scene& scene) {
  return choose_camera(view, ViewFinder(scene));
}

TEST(CameraFromOptions, CommandLineOptionsOverrideTheSceneCamera) {
  const Scene scene = builtin_scene();
  ViewOptions view;
  view.camera = "court";
  view.fov_y = 0.5f;
  const auto camera = choose(view, scene);
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->eye_ws, find_camera(scene, "court")->eye_ws);
  EXPECT_EQ(camera->fov_y, 0.5f);
}

TEST(CameraFromOptions, UnknownCameraNameIsReportedWithTheCameraNamesOfTheScene) {
  ViewOptions view;
  view.camera = "kitchen";
  const auto camera = choose(view, builtin_scene());
  ASSERT_FALSE(camera);
  EXPECT_THAT(camera.error(), HasSubstr("court"));
}

TEST(CameraFromOptions, DefaultCameraThatShowsNothingIsReplacedAndANamedOneIsNot) {
  Scene scene = builtin_scene();
  ViewOptions view;
  EXPECT_EQ(choose(view, scene)->name, scene.cameras[0].name);
  scene.cameras[0].eye_ws = {0, 90, 0};  // above everything, and looks up
  scene.cameras[0].target_ws = {0, 91, 0.01f};
  EXPECT_EQ(choose(view, scene)->name, ViewFinder::kFrame);
  view.camera = scene.cameras[0].name;
  EXPECT_EQ(choose(view, scene)->name, view.camera);
  view.camera = kNoCamera;
  EXPECT_EQ(choose(view, scene)->name, ViewFinder::kFrame);
}

TEST(CameraFromOptions, CameraNamesInTheErrorMessageAreQuoted) {
  Scene scene;
  scene.cameras = {{.name = "great hall"}, {.name = "roof"}};
  ViewOptions view;
  view.camera = "hall";
  EXPECT_EQ(choose(view, scene).error(),
            "the scene has no camera \"hall\"; it has \"great hall\", \"roof\"");
}

TEST(CameraFromOptions, AtMostTenCameraNamesAreListedInTheErrorMessage) {
  Scene scene;
  for (const char digit : {'0', '1', '2', '3', '4', '5', '6', '7', '8', '9'})
    scene.cameras.push_back({.name = {'c', digit}});
  ViewOptions view;
  view.camera = "hall";
  EXPECT_THAT(choose(view, scene).error(), testing::EndsWith("\"c8\", \"c9\""));
  scene.cameras.resize(2000);
  EXPECT_EQ(choose(view, scene).error(),
            "the scene has no camera \"hall\"; it has \"c0\", \"c1\", \"c2\", \"c3\", \"c4\", "
            "\"c5\", \"c6\", \"c7\", \"c8\", \"c9\" and 1990 more");
}

TEST(CameraFromOptions, ViewWithGivenEyeOrTargetIsUprightWhateverTheSceneCamera) {
  Scene scene;
  scene.cameras = {{.name = "tilted", .up_ws = {0.6f, 0.8f, 0.0f}}};
  ViewOptions view;
  EXPECT_EQ(choose(view, scene)->up_ws, glm::vec3(0.6f, 0.8f, 0.0f));
  view.eye = glm::dvec3(6.0, 3.0, -4.0);
  EXPECT_EQ(choose(view, scene)->up_ws, glm::vec3(0, 1, 0));
  view.target = glm::dvec3(1, 0, -3);
  EXPECT_EQ(choose(view, scene)->up_ws, glm::vec3(0, 1, 0));
  view.eye.reset();
  EXPECT_EQ(choose(view, scene)->up_ws, glm::vec3(0, 1, 0));
  view.up_ws = glm::vec3(0, 0, 1);
  EXPECT_EQ(choose(view, scene)->up_ws, glm::vec3(0, 0, 1));
}

TEST(CameraFromOptions, CameraWhoseEyeIsAtItsTargetIsRefused) {
  ViewOptions view;
  view.eye = view.target = glm::dvec3(1.0);
  EXPECT_FALSE(choose(view, builtin_scene()));
}

TEST(CameraFromOptions, PerspectiveViewNeedsANearPlaneInFrontOfTheEye) {
  Scene scene;
  scene.cameras = {{.name = "plan", .orthographic = true, .near_plane = -3.0f}};
  ViewOptions view;
  ASSERT_TRUE(choose(view, scene));
  view.fov_y = 1.0f;
  const auto camera = choose(view, scene);
  ASSERT_FALSE(camera);
  EXPECT_THAT(camera.error(), HasSubstr("--near"));
  view.near_plane = 0.5f;
  EXPECT_TRUE(choose(view, scene));
}

TEST(CameraFromOptions, CameraVectorsWhoseSquaredLengthsOverflowOrUnderflowAreRefused) {
  ViewOptions view;
  view.eye = glm::dvec3(0.0, 0.0, 1.0);
  view.target = glm::dvec3(0.0);
  ASSERT_TRUE(choose(view, builtin_scene()));
  for (const float scale : {1e-30f, 1e30f}) {
    ViewOptions scaled = view;
    scaled.eye = double{scale} * *view.eye;
    EXPECT_FALSE(choose(scaled, builtin_scene())) << scale;
    scaled = view;
    scaled.up_ws = glm::vec3(0.0f, scale, 0.0f);
    EXPECT_FALSE(choose(scaled, builtin_scene())) << scale;
  }
}

TEST(CameraFromOptions, DepthIsReversedByDefaultOnlyInPerspectiveViews) {
  const Scene scene = builtin_scene();
  ViewOptions view;
  EXPECT_TRUE(choose(view, scene)->reversed_z);
  view.reversed_z = false;
  EXPECT_FALSE(choose(view, scene)->reversed_z);
  view.reversed_z.reset();
  view.ortho_height = 5.0f;
  EXPECT_FALSE(choose(view, scene)->reversed_z);
  view.reversed_z = true;
  EXPECT_TRUE(choose(view, scene)->reversed_z);
}

TEST(CameraFromOptions, PositionsInOptionsAreInTheCoordinatesOfTheSceneFile) {
  Scene scene = builtin_scene();
  scene.origin = {1e7, 0.0, -3e7};
  ViewOptions view;
  view.eye = scene.origin + glm::dvec3(0.125, 1.0, 5.0);
  view.target = scene.origin;
  EXPECT_EQ(choose(view, scene)->eye_ws, glm::vec3(0.125f, 1.0f, 5.0f));
  EXPECT_EQ(choose(view, scene)->target_ws, glm::vec3(0.0f));
  EXPECT_EQ(choose(view, scene)->origin, scene.origin);
}

}  // namespace
}  // namespace alcove::sample
