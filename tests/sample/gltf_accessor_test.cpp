// Tests the values read from glTF accessors in each form of storage: types of indices, normalised
// integers, strides and sparse accessors.
#include <gtest/gtest.h>

#include "gltf_maker.h"

namespace alcove::sample {
namespace {

TEST(GltfAccessor, VertexIndicesOfEveryUnsignedIntegerTypeGiveTheSameTriangles) {
  for (const int type : {5121, 5123, 5125}) {
    GltfMaker maker = GltfMaker::triangle();
    maker.primitive()["indices"] = type == 5121   ? maker.add<uint8_t>("SCALAR", {0, 2, 1})
                                   : type == 5123 ? maker.add<uint16_t>("SCALAR", {0, 2, 1})
                                                  : maker.add<uint32_t>("SCALAR", {0, 2, 1});
    const Scene scene = parsed(maker.gltf());
    ASSERT_EQ(triangle_count(scene), 1u) << type;
    EXPECT_LT(area_of(scene.meshes[0], 0).z, 0.0) << type;
  }
}

TEST(GltfAccessor, NormalizedIntegersAreReadAsFloatsFromMinusOneToOne) {
  GltfMaker maker = GltfMaker::triangle();
  const int bytes = maker.view<int8_t>({0, 0, 0, 0, 127, 0, 0, 0, 0, -128, 0, 0}, 4);
  const int position = maker.accessor(bytes, 5120, "VEC3", 3, true);
  maker.primitive()["attributes"] = {
      {"POSITION", position},
      {"TEXCOORD_0", maker.add<uint16_t>("VEC2", {0, 0, 65535, 0, 0, 32768}, true)}};
  // The loader keeps texture coordinates only if a texture uses them.
  const int texture = maker.white_texture();
  maker.json["materials"] = {{{"emissiveTexture", {{"index", texture}}}}};
  maker.primitive()["material"] = 0;
  const Scene scene = parsed(maker.gltf());
  ASSERT_EQ(triangle_count(scene), 1u);
  EXPECT_EQ(corners(scene)[1], glm::vec3(1, 0, 0));
  EXPECT_EQ(corners(scene)[2], glm::vec3(0, -1, 0));
  EXPECT_EQ(scene.meshes[0].uvs[1], glm::vec2(1, 0));
  EXPECT_NEAR(scene.meshes[0].uvs[2].y, 0.5f, 1e-4f);
}

TEST(GltfAccessor, InterleavedAttributesAreReadWithTheirStride) {
  GltfMaker maker = GltfMaker::triangle();
  const int view = maker.view<float>({0, 0, 0, 0, 0, 2, 1, 0, 0, 0, 0, 2, 0, 1, 0, 0, 0, 2}, 24);
  const int position = maker.accessor(view, 5126, "VEC3", 3);
  const int normal = maker.accessor(view, 5126, "VEC3", 3);
  maker.json["accessors"][static_cast<size_t>(normal)]["byteOffset"] = 12;
  maker.primitive()["attributes"] = {{"POSITION", position}, {"NORMAL", normal}};
  const Scene scene = parsed(maker.gltf());
  ASSERT_EQ(triangle_count(scene), 1u);
  EXPECT_EQ(corners(scene)[1], glm::vec3(1, 0, 0));
  EXPECT_EQ(scene.meshes[0].normals[2], glm::vec3(0, 0, 1));
}

TEST(GltfAccessor, SparseAccessorHasItsSparseValuesAndZeroesElsewhere) {
  GltfMaker maker = GltfMaker::triangle();
  const int indices = maker.view<uint8_t>({1, 2});
  const int values = maker.view<float>({3, 0, 0, 0, 4, 0});
  maker.json["accessors"][0].erase("bufferView");
  maker.json["accessors"][0]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
      {"values", {{"bufferView", values}}}};
  const auto read = corners(parsed(maker.gltf()));
  ASSERT_EQ(read.size(), 3u);
  EXPECT_EQ(read[0], glm::vec3(0));
  EXPECT_EQ(read[1], glm::vec3(3, 0, 0));
  EXPECT_EQ(read[2], glm::vec3(0, 4, 0));
}

}  // namespace
}  // namespace alcove::sample
