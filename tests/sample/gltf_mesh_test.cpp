// Triangles of a glTF file, and their transformation by its nodes.
#include <gtest/gtest.h>

#include <cmath>

#include "gltf_maker.h"

namespace alcove::sample {
namespace {

// The normal of a triangle of the first mesh by its winding.
glm::vec3 face_normal(const Scene& scene, size_t triangle) {
  return glm::vec3(glm::normalize(area_of(scene.meshes[0], 3 * triangle)));
}

TEST(GltfMesh, MeshWithoutNormalsKeepsItsSharedVertices) {
  const Scene scene = parsed(GltfMaker::triangle().gltf());
  ASSERT_EQ(triangle_count(scene), 1u);
  EXPECT_TRUE(scene.meshes[0].normals.empty());
  EXPECT_EQ(face_normal(scene, 0), glm::vec3(0, 0, 1));
  EXPECT_EQ(scene.bounds_ws.high, glm::vec3(1, 1, 0));
}

TEST(GltfMesh, TrianglesOfStripsAndFansAllFaceTheSameWay) {
  const std::vector<float> strip = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};
  const std::vector<float> fan = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 1, 0};
  for (const int mode : {5, 6}) {
    for (const bool indexed : {false, true}) {
      GltfMaker maker = GltfMaker::triangle();
      maker.primitive()["attributes"]["POSITION"] = maker.add("VEC3", mode == 5 ? strip : fan);
      maker.primitive()["mode"] = mode;
      if (indexed) maker.primitive()["indices"] = maker.add<uint16_t>("SCALAR", {0, 1, 2, 3, 4});
      const Scene scene = parsed(maker.gltf());
      ASSERT_EQ(triangle_count(scene), 3u) << mode;
      for (size_t i = 0; i < 3; ++i) EXPECT_EQ(face_normal(scene, i), glm::vec3(0, 0, 1));
    }
  }
}

TEST(GltfMesh, TransformsOfParentAndChildNodesAreMultiplied) {
  GltfMaker maker = GltfMaker::triangle();
  const float h = std::sqrt(0.5f);
  maker.json["nodes"] = {{{"children", {1}}, {"translation", {10, 0, 0}}, {"scale", {2, 2, 2}}},
                         {{"mesh", 0}, {"rotation", {0, 0, h, h}}, {"translation", {0, 1, 0}}}};
  const auto read = corners(parsed(maker.gltf()));
  ASSERT_EQ(read.size(), 3u);
  EXPECT_NEAR(glm::distance(read[1], glm::vec3(10, 4, 0)), 0.0f, 1e-5f);
  EXPECT_NEAR(glm::distance(read[2], glm::vec3(8, 2, 0)), 0.0f, 1e-5f);
}

TEST(GltfMesh, TriangleWindingIsReversedUnderANodeThatMirrors) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["nodes"][0]["scale"] = {-1, 1, 1};
  const Scene scene = parsed(maker.gltf());
  ASSERT_EQ(triangle_count(scene), 1u);
  EXPECT_EQ(face_normal(scene, 0), glm::vec3(0, 0, 1));
}

TEST(GltfMesh, TangentsAreMirroredWithTheNodeAndInvalidOnesBecomeZero) {
  GltfMaker maker = painted({{"index", 0}}, {{"index", 0}});
  auto& attributes = maker.primitive()["attributes"];
  attributes["NORMAL"] = maker.add<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  attributes["TANGENT"] = maker.add<float>("VEC4", {1, 0, 0, 1, 0, 0, 0, 1, NAN, 0, 0, -1});
  maker.json["nodes"][0]["scale"] = {-2, 1, 1};
  const Scene scene = parsed(maker.gltf());
  ASSERT_EQ(scene.meshes[0].tangents.size(), 3u);
  EXPECT_EQ(scene.meshes[0].tangents[0], glm::vec4(-1, 0, 0, -1));
  EXPECT_EQ(scene.meshes[0].tangents[1], glm::vec4(0, 0, 0, -1));
  EXPECT_EQ(scene.meshes[0].tangents[2], glm::vec4(0, 0, 0, 1));
}

}  // namespace
}  // namespace alcove::sample
