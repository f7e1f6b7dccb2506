// Cameras of a glTF file: position, direction, planes and target.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "gltf_maker.h"

namespace alcove::sample {
namespace {

TEST(GltfCamera, PerspectiveAndOrthographicCamerasAreRead) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["scenes"][0]["nodes"] = {0, 1, 2, 3};
  maker.json["cameras"] = {
      {{"name", "a"}, {"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.5}}}},
      {{"name", "b"},
       {"type", "perspective"},
       {"perspective", {{"yfov", 1.0}, {"znear", 0.5}, {"zfar", 9.0}}}},
      {{"name", "c"},
       {"type", "orthographic"},
       {"orthographic", {{"xmag", 2.0}, {"ymag", 1.5}, {"znear", 0.0}, {"zfar", 7.0}}}}};
  for (int i = 0; i < 3; ++i)
    maker.json["nodes"].push_back({{"camera", i}, {"translation", {0, 0, 5}}});
  const Scene scene = parsed(maker.gltf());
  ASSERT_EQ(scene.cameras.size(), 3u);
  EXPECT_TRUE(std::isinf(scene.cameras[0].far_plane));
  EXPECT_EQ(scene.cameras[1].far_plane, 9.0f);
  EXPECT_TRUE(scene.cameras[2].orthographic);
  EXPECT_EQ(scene.cameras[2].ortho_height, 3.0f);
  EXPECT_EQ(scene.cameras[0].eye_ws, glm::vec3(0, 0, 5));
  // The target is as far away along the view axis as the middle of the triangle.
  EXPECT_EQ(scene.cameras[0].target_ws, glm::vec3(0, 0, 0));
}

// A triangle and a camera that is rotated by 52 degrees about y. Both are scaled by `scale` and
// moved by `offset` along each axis.
Scene seen_at(double scale, double offset) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.01 * scale}}}}};
  maker.json["nodes"] = {
      {{"mesh", 0}, {"scale", {scale, scale, scale}}},
      {{"camera", 0}, {"translation", {4 * scale, 0, 3 * scale}}, {"rotation", {0, 0.44, 0, 0.9}}},
      {{"children", {0, 1}}, {"translation", {offset, offset, offset}}}};
  maker.json["scenes"][0]["nodes"] = {2};
  return parsed(maker.gltf());
}

TEST(GltfCamera, CameraDirectionDoesNotDependOnScaleAndPositionOfTheScene) {
  const Scene plain = seen_at(1, 0);
  ASSERT_EQ(plain.cameras.size(), 1u);
  const auto direction = [](const Camera& camera) {
    return glm::normalize(glm::dvec3(camera.target_ws) - glm::dvec3(camera.eye_ws));
  };
  for (const auto& [scale, offset] :
       {std::pair{1e10, 0.0}, {1e-9, 0.0}, {1.0, 1e4}, {1.0, 1e5}, {1.0, 1e6}}) {
    SCOPED_TRACE(testing::Message() << "scale " << scale << ", offset " << offset);
    const Scene scene = seen_at(scale, offset);
    ASSERT_EQ(scene.cameras.size(), 1u);
    // The limit is a tenth of a pixel in an image of 960x540.
    EXPECT_LT(glm::distance(direction(scene.cameras[0]), direction(plain.cameras[0])), 1.6e-4);
  }
}

TEST(GltfCamera, CameraTargetIsAsFarAheadAsTheCentreOfTheScene) {
  for (const double scale : {1.0, 1e10, 1e-9}) {
    const Scene scene = seen_at(scale, 0);
    ASSERT_EQ(scene.cameras.size(), 1u);
    const Camera& camera = scene.cameras[0];
    const glm::vec3 centre = 0.5f * (scene.bounds_ws.low + scene.bounds_ws.high);
    const glm::vec3 ahead = camera.target_ws - camera.eye_ws;
    EXPECT_NEAR(glm::dot(centre - camera.target_ws, ahead) / glm::dot(ahead, ahead), 0.0f, 1e-5f)
        << scale;
  }
}

TEST(GltfCamera, CameraThatFacesAwayFromTheSceneKeepsItsDirection) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  maker.json["nodes"].push_back({{"camera", 0}, {"translation", {0, 0, -7}}});
  maker.json["scenes"][0]["nodes"] = {0, 1};
  const Scene scene = parsed(maker.gltf());
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_LT(scene.cameras[0].target_ws.z, -7.0f);
}

}  // namespace
}  // namespace alcove::sample
