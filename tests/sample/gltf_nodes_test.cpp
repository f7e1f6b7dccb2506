// Tests how nodes, skins and instances of a glTF file place meshes, and which parts of the meshes
// its materials cut out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>

#include "draco_maker.h"

namespace alcove::sample {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

// A triangle bound to two joints. Its first two vertices follow joint 0, and the third follows both
// joints with equal weights.
GltfMaker skinned_triangle() {
  GltfMaker maker = GltfMaker::triangle();
  // Undoes a bind pose that lies 10 units along x.
  auto& attributes = maker.primitive()["attributes"];
  attributes["NORMAL"] = maker.add<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  attributes["JOINTS_0"] = maker.add<uint8_t>("VEC4", {0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0});
  attributes["WEIGHTS_0"] = maker.add<float>("VEC4", {1, 0, 0, 0, 2, 0, 0, 0, 0.5f, 0.5f, 0, 0});
  maker.json["skins"] = {
      {{"joints", {1, 2}},
       {"inverseBindMatrices",
        maker.add<float>("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -10, 0, 0, 1,
                                  1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -10, 0, 0, 1})}}};
  const float h = std::sqrt(0.5f);
  maker.json["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {7, 8, 9}}},
                         {{"translation", {10, 0, 5}}, {"rotation", {0, h, 0, h}}},
                         {{"translation", {10, 4, 5}}, {"rotation", {0, h, 0, h}}}};
  maker.json["scenes"][0]["nodes"] = {0, 1};  // a joint may stand outside of the scene
  return maker;
}

TEST(GltfSkin, VerticesOfASkinnedMeshAreTransformedByJointsAndNotByItsNode) {
  const Scene scene = parsed(skinned_triangle().gltf());
  const auto read = corners(scene);
  ASSERT_EQ(read.size(), 3u);
  // The vertex is moved by -10 along x (inverse bind matrix), rotated from x to -z and moved to the
  // joint.
  EXPECT_LT(glm::distance(read[0], glm::vec3(10, 0, 15)), 1e-5f);
  EXPECT_LT(glm::distance(read[1], glm::vec3(10, 0, 14)), 1e-5f);
  EXPECT_LT(glm::distance(read[2], glm::vec3(10, 3, 15)), 1e-5f);
  for (const glm::vec3& normal : scene.meshes[0].normals)
    EXPECT_LT(glm::distance(normal, glm::vec3(1, 0, 0)), 1e-5f);
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(GltfSkin, MissingInverseBindMatricesAreTheIdentity) {
  GltfMaker maker = skinned_triangle();
  maker.json["skins"][0].erase("inverseBindMatrices");
  EXPECT_LT(glm::distance(corners(parsed(maker.gltf()))[0], glm::vec3(10, 0, 5)), 1e-5f);
}

TEST(GltfSkin, JointsSkinsAndMatricesThatDoNotExistAreRefused) {
  using nlohmann::json;
  const auto expect_refusal = [](auto change, const char* sentence) {
    GltfMaker maker = skinned_triangle();
    change(maker.json);
    EXPECT_THAT(refusal(maker.gltf()), HasSubstr(sentence));
  };
  expect_refusal([](json& file) { file["skins"][0]["joints"] = {1}; }, "joint");
  expect_refusal([](json& file) { file["skins"][0]["joints"] = {1, 77}; }, "77");
  expect_refusal([](json& file) { file["nodes"][0]["skin"] = 3; }, "skin 3");
  expect_refusal([](json& file) { file["accessors"].back()["count"] = 1; }, "inverse bind");
}

TEST(GltfInstances, NodesThatDrawTheSameMeshBecomeInstancesOfIt) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["nodes"] = {{{"mesh", 0}},
                         {{"mesh", 0}, {"translation", {5, 0, 0}}},
                         {{"mesh", 0}, {"scale", {-1, 2, 1}}}};
  maker.json["scenes"][0]["nodes"] = {0, 1, 2};
  const Scene scene = parsed(maker.gltf());
  ASSERT_EQ(scene.meshes.size(), 1u);
  ASSERT_EQ(scene.meshes[0].instances.size(), 3u);
  EXPECT_EQ(triangle_count(scene), 3u);
  EXPECT_EQ(scene.bounds_ws.low, glm::vec3(-1, 0, 0));
  EXPECT_EQ(scene.bounds_ws.high, glm::vec3(6, 2, 0));
}

TEST(GltfInstances, NodeScaledToZeroAlongAnAxisBecomesAMeshOfItsOwn) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}}, {{"mesh", 0}, {"scale", {1, 1, 0}}}};
  maker.json["scenes"][0]["nodes"] = {0, 1, 2};
  const Scene scene = parsed(maker.gltf());
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(triangle_count(scene), 3u);
}

TEST(GltfInstances, InstancesOfTheGpuInstancingExtensionAreRead) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["nodes"][0]["translation"] = {0, 10, 0};
  maker.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", maker.add<float>("VEC3", {0, 0, 0, 3, 0, 0})},
      {"SCALE", maker.add<float>("VEC3", {1, 1, 1, 2, 2, 2})}};
  maker.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  const Scene scene = parsed(maker.gltf());
  EXPECT_EQ(triangle_count(scene), 2u);
  EXPECT_EQ(scene.bounds_ws.high, glm::vec3(5, 12, 0));
  EXPECT_THAT(scene.warnings, IsEmpty());
  maker.json["accessors"].back()["count"] = 1;
  EXPECT_THAT(refusal(maker.gltf()), HasSubstr("differ in number"));
}

TEST(GltfNodes, NodesHiddenByTheVisibilityExtensionAreNotDrawn) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["nodes"] = {
      {{"mesh", 0}},
      {{"children", {2}}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}},
      {{"mesh", 0}}};
  maker.json["scenes"][0]["nodes"] = {0, 1};
  EXPECT_EQ(triangle_count(parsed(maker.gltf())), 1u);
}

TEST(GltfNodes, OnlyRequiredExtensionsThatHoldGeometryAreRefused) {
  GltfMaker maker = GltfMaker::triangle();
  for (const char* name : {"KHR_lights_punctual", "KHR_materials_unlit", "KHR_xmp_json_ld",
                           "KHR_texture_basisu", "EXT_texture_webp", "EXT_mesh_features",
                           "KHR_physics_rigid_bodies", "VRMC_vrm", "unknown"}) {
    maker.json["extensionsRequired"] = {name};
    maker.json["extensionsUsed"] = {name};
    const Scene scene = parsed(maker.gltf());
    EXPECT_EQ(triangle_count(scene), 1u) << name;
    EXPECT_THAT(scene.warnings, testing::ElementsAre(HasSubstr(name)));
  }
  for (const char* name : {"KHR_gaussian_splatting", "MPEG_accessor_timed"}) {
    maker.json["extensionsRequired"] = {name};
    EXPECT_THAT(refusal(maker.gltf()), HasSubstr(name));
  }
}

// A triangle with two morph targets, whose first moves a corner and turns the normals.
GltfMaker morphed_triangle() {
  GltfMaker maker = GltfMaker::triangle();
  const int normals = maker.add<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  const int moves = maker.add<float>("VEC3", {0, 0, 0, 0, 0, 4, 0, 0, 0});
  const int turns = maker.add<float>("VEC3", {2, 0, -2, 2, 0, -2, 2, 0, -2});
  maker.primitive()["attributes"]["NORMAL"] = normals;
  // Morphed texture coordinates have two components and are not read.
  const int uvs = maker.add<float>("VEC2", {0, 0, 0, 0, 0, 0});
  maker.primitive()["targets"] = {{{"POSITION", moves}, {"NORMAL", turns}, {"TEXCOORD_0", uvs}},
                                  {{"POSITION", moves}}};
  maker.json["meshes"][0]["weights"] = {0.5, 0.0};
  return maker;
}

TEST(GltfMorph, TargetsAreAppliedAtTheWeightsOfTheMesh) {
  const Scene scene = parsed(morphed_triangle().gltf());
  EXPECT_EQ(corners(scene)[1], glm::vec3(1, 0, 2));
  EXPECT_LT(glm::distance(scene.meshes[0].normals[0], glm::vec3(1, 0, 0)), 1e-6f);
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(GltfMorph, WeightsOfANodeReplaceThoseOfTheMeshForThatNodeOnly) {
  GltfMaker maker = morphed_triangle();
  maker.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"weights", {0.0, 2.0}}}};
  maker.json["scenes"][0]["nodes"] = {0, 1};
  const auto read = corners(parsed(maker.gltf()));
  ASSERT_EQ(read.size(), 6u);
  EXPECT_EQ(read[1], glm::vec3(1, 0, 2));
  EXPECT_EQ(read[4], glm::vec3(1, 0, 8));
}

TEST(GltfMorph, TargetsAreAppliedBeforeSkins) {
  GltfMaker maker = morphed_triangle();
  auto& attributes = maker.primitive()["attributes"];
  attributes["JOINTS_0"] = maker.add<uint8_t>("VEC4", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  attributes["WEIGHTS_0"] = maker.add<float>("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  maker.json["skins"] = {{{"joints", {1}}}};
  maker.json["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"scale", {1, 1, 10}}}};
  maker.json["scenes"][0]["nodes"] = {0, 1};
  EXPECT_EQ(corners(parsed(maker.gltf()))[1], glm::vec3(1, 0, 20));
}

TEST(GltfNodes, NodeThatTheSceneReachesTwiceIsDrawnOnceWithANote) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["nodes"] = {{{"mesh", 0}}, {{"children", {0}}, {"translation", {9, 0, 0}}}};
  maker.json["scenes"][0]["nodes"] = {0};  // the parent is not in the scene
  EXPECT_EQ(corners(parsed(maker.gltf()))[1], glm::vec3(1, 0, 0));
  EXPECT_THAT(parsed(maker.gltf()).warnings, IsEmpty());
  const auto expect_once = [&] {
    const Scene scene = parsed(maker.gltf());
    EXPECT_EQ(triangle_count(scene), 1u);
    EXPECT_THAT(scene.warnings, testing::ElementsAre(testing::HasSubstr("drawn once")));
  };
  maker.json["scenes"][0]["nodes"] = {1, 0};
  expect_once();
  maker.json["scenes"][0]["nodes"] = {0, 0};
  expect_once();
  maker.json["nodes"][0]["children"] = {0};
  expect_once();
}

TEST(GltfNodes, CycleOutsideOfTheSceneMattersOnlyIfItHasAJointOfTheScene) {
  GltfMaker maker = skinned_triangle();
  const auto nodes = maker.json["nodes"].size();
  maker.json["nodes"].push_back({{"mesh", 0}, {"children", {nodes}}});
  EXPECT_EQ(corners(parsed(maker.gltf())).size(), 3u);
  maker.json["skins"][0]["joints"][1] = nodes;
  EXPECT_THAT(refusal(maker.gltf()), HasSubstr("form a cycle"));
}

TEST(GltfCompression, ViewAndPrimitiveThatCannotBeDecompressedAreReplacedByTheirFallback) {
  GltfMaker view = GltfMaker::triangle(), primitive = view;
  view.json["bufferViews"][0]["extensions"]["KHR_meshopt_compression"] = {
      {"buffer", 0}, {"byteOffset", 0},      {"byteLength", 36}, {"byteStride", 12},
      {"count", 3},  {"mode", "ATTRIBUTES"}, {"filter", "COLOR"}};
  primitive.primitive()["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", 0}, {"attributes", {{"POSITION", 0}}}};
  for (const GltfMaker& maker : {view, primitive}) {
    const Scene scene = parsed(maker.gltf());
    EXPECT_EQ(corners(scene)[1], glm::vec3(1, 0, 0));
    EXPECT_THAT(scene.warnings, testing::ElementsAre(testing::HasSubstr("fallback")));
  }
}

// A quad whose positions and indices are compressed. The positions are 16-bit, normalised.
TEST(GltfCompression, MeshoptViewsAreDecompressed) {
  GltfMaker maker = GltfMaker::triangle();
  const std::vector<int16_t> positions = {0,     0,     0, 0, 32767, 0,     0, 0,
                                          32767, 32767, 0, 0, 0,     32767, 0, 0};
  const std::vector<uint32_t> triangles = {0, 1, 2, 0, 2, 3};
  std::vector<uint8_t> vertices(meshopt_encodeVertexBufferBound(4, 8));
  vertices.resize(
      meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), positions.data(), 4, 8));
  std::vector<uint8_t> indices(meshopt_encodeIndexBufferBound(6, 4));
  indices.resize(meshopt_encodeIndexBuffer(indices.data(), indices.size(), triangles.data(), 6));
  const auto compress = [&](int view, const char* mode, int stride, int count) {
    nlohmann::json& json = maker.json["bufferViews"][static_cast<size_t>(view)];
    json["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                     {"byteOffset", json["byteOffset"]},
                                                     {"byteLength", json["byteLength"]},
                                                     {"byteStride", stride},
                                                     {"mode", mode},
                                                     {"count", count}};
    json["buffer"] = 7;  // the fallback, which does not exist here
    json["byteLength"] = stride * count;
  };
  const int position_view = maker.view(vertices, 8), index_view = maker.view(indices);
  compress(position_view, "ATTRIBUTES", 8, 4);
  compress(index_view, "TRIANGLES", 2, 6);
  maker.primitive()["attributes"]["POSITION"] =
      maker.accessor(position_view, 5122, "VEC3", 4, true);
  maker.primitive()["indices"] = maker.accessor(index_view, 5123, "SCALAR", 6);
  maker.json["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
  const Scene scene = parsed(maker.gltf());
  EXPECT_EQ(triangle_count(scene), 2u);
  EXPECT_EQ(scene.bounds_ws.high, glm::vec3(1, 1, 0));
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(GltfCompression, DracoPrimitivesAreDecompressed) {
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    const Scene scene = parsed(draco_square(method).gltf());
    ASSERT_EQ(triangle_count(scene), 2u);
    EXPECT_EQ(scene.bounds_ws.high, glm::vec3(1, 1, 0));
    EXPECT_GT(scene.meshes[0].normals.at(0).z, 0.99f);
    EXPECT_THAT(scene.warnings, IsEmpty());
  }
}

TEST(GltfCompression, DamagedDracoPrimitivesAreRefused) {
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    const GltfMaker whole = draco_square(method);
    const auto size = whole.json["bufferViews"][0]["byteLength"].get<size_t>();
    for (size_t length = 0; length < size; ++length) {
      GltfMaker maker = whole;
      maker.json["bufferViews"][0]["byteLength"] = length;
      EXPECT_THAT(refusal(maker.gltf()), testing::HasSubstr("is no Draco mesh")) << length;
    }
    // The number of triangles, as 2^28 - 1 in a variable number of bytes. It follows the header of
    // 11 bytes, and with the edgebreaker algorithm a byte and the number of vertices.
    GltfMaker maker = whole;
    const bool sequential = method == draco::MESH_SEQUENTIAL_ENCODING;
    const std::vector<uint8_t> many = {0xff, 0xff, 0xff, 0x7f};
    std::copy(many.begin(), many.end(), maker.bytes.begin() + (sequential ? 11 : 13));
    EXPECT_THAT(refusal(maker.gltf()), testing::HasSubstr("is no Draco mesh"));
    maker = whole;
    auto& extension = maker.primitive()["extensions"]["KHR_draco_mesh_compression"];
    extension["attributes"]["NORMAL"] = 7;
    EXPECT_THAT(refusal(maker.gltf()), testing::HasSubstr("a Draco mesh whose NORMAL is missing"));
  }
}

// Ten triangles around the origin, and a camera, moved by `offset`.
GltfMaker scene_at(const glm::dvec3& offset) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["accessors"][0]["min"] = {0, 0, 0};
  maker.json["accessors"][0]["max"] = {1, 1, 0};
  maker.json["cameras"] = {
      {{"name", "c"}, {"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}}};
  maker.json["nodes"] = {
      {{"mesh", 0}, {"translation", {offset.x + 0.3, offset.y, offset.z - 0.7}}},
      {{"camera", 0}, {"translation", {offset.x + 0.5, offset.y + 0.3, offset.z + 2.25}}}};
  maker.json["scenes"][0]["nodes"] = {0, 1};
  return maker;
}

TEST(GltfNodes, SceneFarFromTheOriginIsMovedCloseToTheOrigin) {
  const Scene near_scene = parsed(scene_at(glm::dvec3(0.0)).gltf());
  EXPECT_EQ(near_scene.origin, glm::dvec3(0.0));
  const glm::dvec3 offset(100000.3, -4e6, 2e8 + 0.7);
  const Scene far_scene = parsed(scene_at(offset).gltf());
  EXPECT_LT(glm::distance(far_scene.origin, offset), 3.0);
  const auto here = corners(near_scene), there = corners(far_scene);
  const glm::vec3 shift(offset - far_scene.origin);
  for (size_t i = 0; i < 3; ++i) EXPECT_LT(glm::distance(here[i] + shift, there[i]), 1e-6f);
  ASSERT_EQ(far_scene.cameras.size(), 1u);
  EXPECT_LT(glm::distance(near_scene.cameras[0].eye_ws + shift, far_scene.cameras[0].eye_ws),
            1e-6f);
  EXPECT_EQ(far_scene.cameras[0].origin, far_scene.origin);
}

TEST(GltfNodes, SceneIsNotMovedIfOnlyAPartOfItIsFarAway) {
  GltfMaker maker = scene_at(glm::dvec3(0.0));
  for (int i = 0; i < 4; ++i) maker.json["nodes"].push_back({{"mesh", 0}});
  maker.json["nodes"].push_back({{"mesh", 0}, {"translation", {1e6, 0, 0}}});
  maker.json["scenes"][0]["nodes"] = {0, 1, 2, 3, 4, 5, 6};
  EXPECT_EQ(parsed(maker.gltf()).origin, glm::dvec3(0.0));
}

Material only_material(const nlohmann::json& material) {
  GltfMaker maker = GltfMaker::triangle();
  maker.white_texture();
  maker.json["materials"] = {material};
  maker.primitive()["material"] = 0;
  return parsed(maker.gltf()).materials[0];
}

TEST(GltfMaterial, MaterialsAreSingleSidedUnlessTheFileSaysOtherwise) {
  EXPECT_FALSE(only_material(nlohmann::json::object()).double_sided);
  EXPECT_TRUE(only_material({{"doubleSided", true}}).double_sided);
}

TEST(GltfMaterial, SpecularGlossinessMaterialGivesBaseColourAlphaAndRoughness) {
  const Material material = only_material({{"alphaMode", "MASK"},
                                           {"extensions",
                                            {{"KHR_materials_pbrSpecularGlossiness",
                                              {{"diffuseFactor", {0.25, 0.5, 0.75, 0.5}},
                                               {"diffuseTexture", {{"index", 0}, {"texCoord", 1}}},
                                               {"glossinessFactor", 0.25}}}}}});
  EXPECT_EQ(material.base_color, glm::vec4(0.25f, 0.5f, 0.75f, 0.5f));
  EXPECT_EQ(material.base_color_texture.image, 0);
  EXPECT_EQ(material.base_color_texture.uv_set, 1u);
  EXPECT_EQ(material.metallic, 0.0f);
  EXPECT_EQ(material.roughness, 0.75f);
}

TEST(GltfMaterial, BlendedMaterialWithAlphaZeroIsReportedAndNotDrawn) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["materials"] = {{{"name", "ghost"},
                              {"alphaMode", "BLEND"},
                              {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0}}}}},
                             nlohmann::json::object()};
  const nlohmann::json visible = maker.primitive();
  maker.primitive()["material"] = 0;
  maker.json["meshes"][0]["primitives"].push_back(visible);
  const Scene scene = parsed(maker.gltf());
  EXPECT_EQ(scene.meshes.size(), 1u);
  EXPECT_THAT(scene.warnings, testing::Contains(HasSubstr("ghost")));
}

}  // namespace
}  // namespace alcove::sample
