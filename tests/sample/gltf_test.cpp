#include "scene/gltf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "gltf_maker.h"
#include "scene/load_scene.h"
#include "temporary_folder.h"

namespace alcove::sample {
namespace {

using testing::HasSubstr;

std::string refusal(const std::vector<uint8_t>& bytes) {
  const auto scene = parse_gltf(bytes, "test.gltf", "");
  EXPECT_FALSE(scene);
  if (scene) return "";
  EXPECT_THAT(scene.error(), HasSubstr("test.gltf"));
  EXPECT_EQ(scene.error().find('\n'), std::string::npos);
  return scene.error();
}

// Corners in the order of the indices.
std::vector<glm::vec3> corners(const Scene& scene) {
  std::vector<glm::vec3> out;
  for (const Mesh& mesh : scene.meshes) {
    for (const uint32_t i : mesh.indices) out.push_back(mesh.positions_ws[i]);
  }
  return out;
}

TEST(Gltf, TriangleWithoutNormalsGetsItsFaceNormal) {
  const Scene scene = parsed(GltfMaker::triangle().gltf());
  ASSERT_EQ(triangle_count(scene), 1u);
  EXPECT_EQ(scene.meshes[0].normals_ws[0], glm::vec3(0, 0, 1));
  EXPECT_EQ(scene.bounds_ws.high, glm::vec3(1, 1, 0));
}

TEST(Gltf, BinaryFileReadsAsItsTextTwin) {
  const GltfMaker maker = GltfMaker::triangle();
  EXPECT_EQ(corners(parsed(maker.glb())), corners(parsed(maker.gltf())));
}

TEST(Gltf, IndicesOfEveryUnsignedTypeReadAlike) {
  for (const int type : {5121, 5123, 5125}) {
    GltfMaker maker = GltfMaker::triangle();
    const int view = type == 5121   ? maker.view<uint8_t>({0, 2, 1})
                     : type == 5123 ? maker.view<uint16_t>({0, 2, 1})
                                    : maker.view<uint32_t>({0, 2, 1});
    maker.primitive()["indices"] = maker.accessor(view, type, "SCALAR", 3);
    const Scene scene = parsed(maker.gltf());
    ASSERT_EQ(triangle_count(scene), 1u) << type;
    EXPECT_EQ(scene.meshes[0].normals_ws[0], glm::vec3(0, 0, -1)) << type;
  }
}

TEST(Gltf, StripsAndFansKeepOneSideWithAndWithoutIndices) {
  const std::vector<float> strip = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};
  const std::vector<float> fan = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 1, 0};
  for (const int mode : {5, 6}) {
    for (const bool indexed : {false, true}) {
      GltfMaker maker = GltfMaker::triangle();
      const int view = maker.view<float>(mode == 5 ? strip : fan);
      maker.primitive()["attributes"]["POSITION"] = maker.accessor(view, 5126, "VEC3", 5);
      maker.primitive()["mode"] = mode;
      if (indexed) {
        const int indices = maker.view<uint16_t>({0, 1, 2, 3, 4});
        maker.primitive()["indices"] = maker.accessor(indices, 5123, "SCALAR", 5);
      }
      const Scene scene = parsed(maker.gltf());
      ASSERT_EQ(triangle_count(scene), 3u) << mode;
      for (const glm::vec3& n : scene.meshes[0].normals_ws) EXPECT_EQ(n, glm::vec3(0, 0, 1));
    }
  }
}

TEST(Gltf, NormalizedIntegersMapToTheUnitRange) {
  GltfMaker maker = GltfMaker::triangle();
  const int bytes = maker.view<int8_t>({0, 0, 0, 0, 127, 0, 0, 0, 0, -128, 0, 0}, 4);
  const int shorts = maker.view<uint16_t>({0, 0, 65535, 0, 0, 32768});
  const int position = maker.accessor(bytes, 5120, "VEC3", 3, true);
  maker.primitive()["attributes"] = {{"POSITION", position},
                                     {"TEXCOORD_0", maker.accessor(shorts, 5123, "VEC2", 3, true)}};
  const Scene scene = parsed(maker.gltf());
  ASSERT_EQ(triangle_count(scene), 1u);
  EXPECT_EQ(corners(scene)[1], glm::vec3(1, 0, 0));
  EXPECT_EQ(corners(scene)[2], glm::vec3(0, -1, 0));
  EXPECT_EQ(scene.meshes[0].uvs[1], glm::vec2(1, 0));
  EXPECT_NEAR(scene.meshes[0].uvs[2].y, 0.5f, 1e-4f);
}

TEST(Gltf, InterleavedAttributesReadThroughTheirStride) {
  GltfMaker maker = GltfMaker::triangle();
  const int view = maker.view<float>({0, 0, 0, 0, 0, 2, 1, 0, 0, 0, 0, 2, 0, 1, 0, 0, 0, 2}, 24);
  const int position = maker.accessor(view, 5126, "VEC3", 3);
  const int normal = maker.accessor(view, 5126, "VEC3", 3);
  maker.json["accessors"][static_cast<size_t>(normal)]["byteOffset"] = 12;
  maker.primitive()["attributes"] = {{"POSITION", position}, {"NORMAL", normal}};
  const Scene scene = parsed(maker.gltf());
  ASSERT_EQ(triangle_count(scene), 1u);
  EXPECT_EQ(corners(scene)[1], glm::vec3(1, 0, 0));
  EXPECT_EQ(scene.meshes[0].normals_ws[2], glm::vec3(0, 0, 1));
}

TEST(Gltf, SparseValuesReplaceAndZeroesFillTheRest) {
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

TEST(Gltf, NodesComposeDownTheHierarchy) {
  GltfMaker maker = GltfMaker::triangle();
  const float h = std::sqrt(0.5f);
  maker.json["nodes"] = {{{"children", {1}}, {"translation", {10, 0, 0}}, {"scale", {2, 2, 2}}},
                         {{"mesh", 0}, {"rotation", {0, 0, h, h}}, {"translation", {0, 1, 0}}}};
  const auto read = corners(parsed(maker.gltf()));
  ASSERT_EQ(read.size(), 3u);
  EXPECT_NEAR(glm::distance(read[1], glm::vec3(10, 4, 0)), 0.0f, 1e-5f);
  EXPECT_NEAR(glm::distance(read[2], glm::vec3(8, 2, 0)), 0.0f, 1e-5f);
}

TEST(Gltf, MirroringTurnsTheWindingSoThatFacesKeepTheirSide) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["nodes"][0]["scale"] = {-1, 1, 1};
  const Scene scene = parsed(maker.gltf());
  ASSERT_EQ(triangle_count(scene), 1u);
  EXPECT_EQ(scene.meshes[0].normals_ws[0], glm::vec3(0, 0, 1));
}

TEST(Gltf, WhatIsLeftOutIsSaid) {
  GltfMaker maker = textured({{"index", 0}}, {{"index", 0}, {"texCoord", 2}});
  maker.json["extensionsUsed"] = {"KHR_texture_transform", "KHR_materials_unlit"};
  maker.primitive()["attributes"]["COLOR_0"] = maker.primitive()["attributes"]["POSITION"];
  const Scene scene = parsed(maker.gltf());
  EXPECT_THAT(
      scene.warnings,
      testing::UnorderedElementsAre(
          "The extension KHR_materials_unlit is left out.",
          "Material \"tiles\" has its normal map by texture coordinates 2, neither 0 nor 1: "
          "it is left out.",
          "Mesh 0 has colours of its vertices, which are left out.",
          "texture 0 has no image that is read here and is left out."));
}

TEST(Gltf, WhatBlendsIsOpaqueUnlessItIsCutOutAndBothAreSaid) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["materials"] = {{{"name", "leaf"}, {"alphaMode", "BLEND"}}};
  maker.primitive()["material"] = 0;
  const TemporaryFolder folder;
  const std::string file = (folder.path / "leaf.gltf").string();
  const std::vector<uint8_t> bytes = maker.gltf();
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  for (const bool cut : {false, true}) {
    const auto scene = load_scene(file, cut);
    ASSERT_TRUE(scene) << scene.error();
    EXPECT_EQ(scene->materials[0].alpha_mode, cut ? AlphaMode::kMask : AlphaMode::kBlend);
    EXPECT_THAT(scene->warnings, testing::ElementsAre(testing::HasSubstr(
                                     cut ? "\"leaf\" blends: it is cut out" : "--cut-blends")));
  }
}

TEST(Gltf, TangentsTurnWithTheNodeAndMirrorWithIt) {
  GltfMaker maker = GltfMaker::triangle();
  const int normals = maker.view<float>({0, 0, 1, 0, 0, 1, 0, 0, 1});
  const int tangents = maker.view<float>({1, 0, 0, 1, 0, 0, 0, 1, NAN, 0, 0, -1});
  auto& attributes = maker.primitive()["attributes"];
  attributes["NORMAL"] = maker.accessor(normals, 5126, "VEC3", 3);
  attributes["TANGENT"] = maker.accessor(tangents, 5126, "VEC4", 3);
  maker.json["nodes"][0]["scale"] = {-2, 1, 1};
  const Scene scene = parsed(maker.gltf());
  ASSERT_EQ(scene.meshes[0].tangents_ws.size(), 3u);
  EXPECT_EQ(scene.meshes[0].tangents_ws[0], glm::vec4(-1, 0, 0, -1));
  EXPECT_EQ(scene.meshes[0].tangents_ws[1], glm::vec4(0, 0, 0, -1));
  EXPECT_EQ(scene.meshes[0].tangents_ws[2], glm::vec4(0, 0, 0, 1));
}

TEST(Gltf, CamerasOfEveryKindArrive) {
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
  for (int i = 0; i < 3; ++i) {
    maker.json["nodes"].push_back({{"camera", i}, {"translation", {0, 0, 5}}});
  }
  const Scene scene = parsed(maker.gltf());
  ASSERT_EQ(scene.cameras.size(), 3u);
  EXPECT_TRUE(std::isinf(scene.cameras[0].far_plane));
  EXPECT_EQ(scene.cameras[1].far_plane, 9.0f);
  EXPECT_TRUE(scene.cameras[2].orthographic);
  EXPECT_EQ(scene.cameras[2].ortho_height, 3.0f);
  EXPECT_EQ(scene.cameras[0].eye_ws, glm::vec3(0, 0, 5));
  // As deep as the middle of the triangle.
  EXPECT_EQ(scene.cameras[0].target_ws, glm::vec3(0, 0, 0));
}

// A camera turned by a quarter and some about y, and the triangle, both `scale` times as large and
// moved by `offset`.
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

TEST(Gltf, ACameraLooksTheSameWayAtAnyScaleAndAnywhere) {
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
    // A tenth of a pixel in an image of 960x540.
    EXPECT_LT(glm::distance(direction(scene.cameras[0]), direction(plain.cameras[0])), 1.6e-4);
  }
}

TEST(Gltf, ACameraTurnsAboutWhatItLooksAt) {
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

TEST(Gltf, ACameraWithItsBackToTheSceneStillLooksAhead) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  maker.json["nodes"].push_back({{"camera", 0}, {"translation", {0, 0, -7}}});
  maker.json["scenes"][0]["nodes"] = {0, 1};
  const Scene scene = parsed(maker.gltf());
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_LT(scene.cameras[0].target_ws.z, -7.0f);
}

TEST(Gltf, BoundsAreThoseOfTheTriangles) {
  GltfMaker maker = GltfMaker::triangle();
  const int positions = maker.view<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1e6, 0, 0});
  const int normals = maker.view<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  maker.primitive()["attributes"] = {{"POSITION", maker.accessor(positions, 5126, "VEC3", 4)},
                                     {"NORMAL", maker.accessor(normals, 5126, "VEC3", 4)}};
  maker.primitive()["indices"] = maker.accessor(maker.view<uint16_t>({0, 1, 2}), 5123, "SCALAR", 3);
  const Scene scene = parsed(maker.gltf());
  EXPECT_EQ(scene.bounds_ws.low, glm::vec3(0));
  EXPECT_EQ(scene.bounds_ws.high, glm::vec3(1, 1, 0));
}

TEST(Gltf, ExternalBufferIsReadFromTheFolderAndNowhereElse) {
  const TemporaryFolder folder;
  GltfMaker maker = GltfMaker::triangle();
  std::filesystem::create_directories(folder.path / "inside");
  const auto write = [](const std::filesystem::path& file, const auto& bytes) {
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  };
  write(folder.path / "inside" / "own.bin", maker.bytes);
  write(folder.path / "outside.bin", maker.bytes);
  for (const auto& [uri, allowed] :
       {std::pair{"own.bin", true}, {"../outside.bin", false}, {"missing.bin", false}}) {
    nlohmann::json json = maker.json;
    json["buffers"] = {{{"byteLength", maker.bytes.size()}, {"uri", uri}}};
    const std::filesystem::path file = folder.path / "inside" / "scene.gltf";
    write(file, json.dump());
    const auto scene = load_gltf(file);
    EXPECT_EQ(scene.has_value(), allowed) << uri;
    if (!scene) {
      EXPECT_THAT(scene.error(), HasSubstr("scene.gltf"));
    }
  }
}

TEST(Gltf, AFileThatIsThereAndMayNotBeReadIsNotCalledMissing) {
  const TemporaryFolder folder;
  const std::filesystem::path inside = folder.path / "inside";
  std::filesystem::create_directories(inside);
  GltfMaker maker = painted({{"index", 0}}, {{"index", 0}});
  std::ofstream(folder.path / "own.bin") << "elsewhere";
  std::ofstream(folder.path / "t.png") << "elsewhere";
  std::filesystem::create_symlink(folder.path / "own.bin", inside / "link.bin");
  for (const std::string uri : {"../own.bin", "link.bin"}) {
    nlohmann::json json = maker.json;
    json["buffers"] = {{{"byteLength", maker.bytes.size()}, {"uri", uri}}};
    std::ofstream(inside / "scene.gltf") << json.dump();
    const auto scene = load_gltf(inside / "scene.gltf");
    ASSERT_FALSE(scene);
    EXPECT_THAT(scene.error(), HasSubstr(uri + " lies outside the scene's folder"));
  }
  maker.json["images"][0] = {{"uri", "../t.png"}};
  const std::vector<uint8_t> bytes = maker.gltf();
  const auto scene = parse_gltf(bytes, "test.gltf", inside);
  ASSERT_TRUE(scene) << scene.error();
  EXPECT_THAT(scene->warnings,
              testing::Contains(HasSubstr("image 0 (../t.png, outside the scene's folder)")));
}

TEST(Gltf, WhatKeepsAFileFromBeingOpenedIsSaid) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("loop.gltf", folder.path / "loop.gltf");
  const auto scene = load_gltf(folder.path / "loop.gltf");
  ASSERT_FALSE(scene);
  EXPECT_THAT(
      scene.error(),
      testing::EndsWith(std::make_error_code(std::errc::too_many_symbolic_link_levels).message()));
}

TEST(Gltf, MissingFileIsNamed) {
  const auto scene = load_gltf("no/such/scene.glb");
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error(), "cannot read no/such/scene.glb: there is no such file");
}

// A hostile file: what is changed, and a word of the sentence that refuses it.
struct Hostile {
  const char* name;
  void (*spoil)(GltfMaker&);
  const char* word;
};

class HostileGltf : public testing::TestWithParam<Hostile> {};

TEST_P(HostileGltf, IsRefusedInOneSentence) {
  GltfMaker maker = GltfMaker::triangle();
  GetParam().spoil(maker);
  EXPECT_THAT(refusal(maker.gltf()), HasSubstr(GetParam().word));
  refusal(maker.glb());
}

const Hostile kHostile[] = {
    {"HugeCount", [](GltfMaker& m) { m.json["accessors"][0]["count"] = 4000000000u; },
     "accessor 0"},
    {"CountPastTheView", [](GltfMaker& m) { m.json["accessors"][0]["count"] = 4; }, "past the end"},
    {"OffsetPastTheView", [](GltfMaker& m) { m.json["accessors"][0]["byteOffset"] = 4294967000u; },
     "past the end"},
    {"ViewPastTheBuffer", [](GltfMaker& m) { m.json["bufferViews"][0]["byteLength"] = 1000; },
     "buffer view 0"},
    {"NoSuchView", [](GltfMaker& m) { m.json["accessors"][0]["bufferView"] = 7; }, "buffer view"},
    {"NoSuchBuffer", [](GltfMaker& m) { m.json["bufferViews"][0]["buffer"] = 9; }, "buffer"},
    {"NoSuchAccessor", [](GltfMaker& m) { m.primitive()["attributes"]["POSITION"] = 12; },
     "accessor 12"},
    {"NoSuchMesh", [](GltfMaker& m) { m.json["nodes"][0]["mesh"] = 3; }, "mesh 3"},
    {"NoSuchMaterial", [](GltfMaker& m) { m.primitive()["material"] = 2; }, "material 2"},
    {"NoSuchNode", [](GltfMaker& m) { m.json["scenes"][0]["nodes"] = {5}; }, "node 5"},
    {"NodeCycle", [](GltfMaker& m) { m.json["nodes"][0]["children"] = {0}; }, "twice"},
    {"IndexPastTheVertices",
     [](GltfMaker& m) {
       const int view = m.view<uint16_t>({0, 1, 3});
       m.primitive()["indices"] = m.accessor(view, 5123, "SCALAR", 3);
     },
     "index 3"},
    {"FloatIndices",
     [](GltfMaker& m) {
       const int view = m.view<float>({0, 1, 2});
       m.primitive()["indices"] = m.accessor(view, 5126, "SCALAR", 3);
     },
     "unsigned"},
    {"NotANumberPosition",
     [](GltfMaker& m) {
       const float nan = std::numeric_limits<float>::quiet_NaN();
       std::memcpy(m.bytes.data(), &nan, sizeof(nan));
     },
     "finite"},
    {"ScalarPositions", [](GltfMaker& m) { m.json["accessors"][0]["type"] = "SCALAR"; },
     "components"},
    {"DeepNesting",
     [](GltfMaker& m) {
       nlohmann::json deep = 1;
       for (int i = 0; i < 500; ++i) deep = nlohmann::json::array({deep});
       m.json["extras"] = deep;
     },
     "nested"},
    {"UnknownRequiredExtension",
     [](GltfMaker& m) { m.json["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
     "KHR_draco_mesh_compression"},
    {"NormalScalePastAFloat",
     [](GltfMaker& m) {
       m = textured({{"index", 0}}, {{"index", 0}, {"scale", 1e300}});
     },
     "material \"tiles\" has a normal map whose scale is not finite"},
    {"TransformPastAFloat",
     [](GltfMaker& m) {
       m = textured(transformed({{"offset", {0, -1e39}}}), {{"index", 0}});
     },
     "material \"tiles\" has a texture transform"},
    {"NoSuchNormalMap",
     [](GltfMaker& m) {
       m = textured({{"index", 0}}, {{"index", 4}});
     },
     "material \"tiles\" has no texture 4"},
    {"ShortTangents",
     [](GltfMaker& m) {
       const int normals = m.accessor(0, 5126, "VEC3", 3);
       const int tangents = m.accessor(m.view<float>({1, 0, 0, 1}), 5126, "VEC4", 1);
       m.primitive()["attributes"]["NORMAL"] = normals;
       m.primitive()["attributes"]["TANGENT"] = tangents;
     },
     "tangents for some"},
    {"ShortSecondTextureCoordinates",
     [](GltfMaker& m) {
       m = painted({{"index", 0}}, {{"index", 0}, {"texCoord", 1}});
       const int uvs = m.accessor(m.view<float>({0, 0}), 5126, "VEC2", 1);
       m.primitive()["attributes"]["TEXCOORD_1"] = uvs;
     },
     "texture coordinates for some"},
    {"NoSuchSampler",
     [](GltfMaker& m) {
       m = painted({{"index", 0}}, {{"index", 0}});
       m.json["textures"][0]["sampler"] = 3;
     },
     "material \"tiles\" has a texture without its sampler 3"},
    {"NoTriangles", [](GltfMaker& m) { m.primitive()["mode"] = 0; }, "no triangles"},
};
INSTANTIATE_TEST_SUITE_P(All, HostileGltf, testing::ValuesIn(kHostile),
                         [](const auto& param) { return std::string(param.param.name); });

TEST(Gltf, ASentenceStaysShortHoweverLongWhatItSpeaksOf) {
  GltfMaker maker = GltfMaker::triangle();
  nlohmann::json json = maker.json;
  json["buffers"] = {
      {{"byteLength", 36}, {"uri", "data:nonsense;base64," + std::string(2000000, 'A')}}};
  const std::string text = json.dump();
  const std::string data = refusal({text.begin(), text.end()});
  EXPECT_LT(data.size(), 250u);
  EXPECT_THAT(data, testing::Not(HasSubstr("AAAA")));
  // A name, cut between two letters of it though each is two bytes.
  std::string name = "x";
  for (int i = 0; i < 1000; ++i) name += "\xc3\xa9";
  maker.json["meshes"][0]["name"] = name;
  maker.primitive()["attributes"]["COLOR_0"] = 0;
  const Scene scene = parsed(maker.gltf());
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_LT(scene.warnings[0].size(), 250u);
  EXPECT_THAT(scene.warnings[0], testing::EndsWith("\xc3\xa9..."));
  maker.primitive()["attributes"]["POSITION"] = 9;
  EXPECT_LT(refusal(maker.gltf()).size(), 250u);
}

TEST(Gltf, OnlyTheSecondVersionIsRead) {
  GltfMaker maker = GltfMaker::triangle();
  for (const char* version : {"1.0", "3.0", "20.0"}) {
    maker.json["asset"]["version"] = version;
    EXPECT_THAT(refusal(maker.gltf()), HasSubstr("glTF " + std::string(version)));
    EXPECT_THAT(refusal(maker.glb()), HasSubstr("glTF " + std::string(version)));
  }
  maker.json["asset"]["version"] = "2.1";
  parsed(maker.gltf());
  std::vector<uint8_t> glb = maker.glb();
  glb[4] = 1;
  EXPECT_THAT(refusal(glb), HasSubstr("binary glTF of version 1"));
}

TEST(Gltf, EveryCutOfAFileIsReadOrRefused) {
  const auto glb = GltfMaker::triangle().glb();
  for (size_t size = 0; size < glb.size(); ++size) {
    const std::vector<uint8_t> cut(glb.begin(), glb.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(parse_gltf(cut, "cut.glb", "")) << size;
  }
}

TEST(Gltf, InstancesBeyondTheLimitAreRefused) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["nodes"].clear();
  for (int i = 0; i < 100; ++i) {
    maker.json["nodes"].push_back({{"mesh", 0}});
    maker.json["scenes"][0]["nodes"][static_cast<size_t>(i)] = i;
  }
  GltfLimits limits;
  limits.vertices = 200;
  const auto scene = parse_gltf(maker.gltf(), "many.gltf", "", limits);
  EXPECT_FALSE(scene);
}

// Reading them takes as long as if they had an area.
TEST(Gltf, InstancesThatComeToNothingCountTowardsTheLimitToo) {
  for (const bool indexed : {false, true}) {
    GltfMaker maker = GltfMaker::triangle();
    maker.json["accessors"][0].erase("bufferView");  // zeroes
    if (indexed) {
      maker.primitive()["indices"] =
          maker.accessor(maker.view<uint16_t>({0, 1, 2, 2, 1, 0}), 5123, "SCALAR", 6);
    }
    maker.json["nodes"].clear();
    for (int i = 0; i < 100; ++i) {
      maker.json["nodes"].push_back({{"mesh", 0}});
      maker.json["scenes"][0]["nodes"][static_cast<size_t>(i)] = i;
    }
    GltfLimits limits;
    (indexed ? limits.indices : limits.vertices) = 200;
    const auto scene = parse_gltf(maker.gltf(), "many.gltf", "", limits);
    ASSERT_FALSE(scene);
    EXPECT_THAT(scene.error(), testing::Not(HasSubstr("no triangles")));
  }
}

TEST(Gltf, PartsThatAreLeftOutCountTowardsTheLimitToo) {
  GltfMaker maker = GltfMaker::triangle();
  maker.primitive()["mode"] = 1;
  const nlohmann::json lines = maker.primitive();
  for (int i = 0; i < 100; ++i) maker.json["meshes"][0]["primitives"].push_back(lines);
  GltfLimits limits;
  limits.primitives = 50;
  const auto scene = parse_gltf(maker.gltf(), "lines.gltf", "", limits);
  ASSERT_FALSE(scene);
  EXPECT_THAT(scene.error(), HasSubstr("parts"));
}

}  // namespace
}  // namespace alcove::sample
