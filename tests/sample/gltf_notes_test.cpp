// Warnings and error sentences about glTF files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "gltf_maker.h"
#include "scene/load_scene.h"
#include "temporary_folder.h"

namespace alcove::sample {
namespace {

using testing::HasSubstr;

TEST(GltfNotes, TexturesAndExtensionsThatAreLeftOutAreReported) {
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
          "texture 0 has no image that is read here and is left out."));
}

TEST(GltfNotes, MaterialsAreDrawnAsChosenAndBlendedOnesAreReported) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["materials"] = {{{"name", "leaf"}, {"alphaMode", "BLEND"}}};
  maker.primitive()["material"] = 0;
  const TemporaryFolder folder;
  const std::string file = folder.write("leaf.gltf", maker.gltf());
  for (const bool cut : {false, true}) {
    const auto scene = load_scene(file, {.cut_blends = cut});
    ASSERT_TRUE(scene) << scene.error();
    EXPECT_EQ(scene->materials[0].alpha_mode, cut ? AlphaMode::mask : AlphaMode::blend);
    EXPECT_THAT(scene->warnings,
                testing::ElementsAre(HasSubstr(cut ? "cut out elsewhere" : "--cut-blends")));
    EXPECT_FALSE(scene->materials[0].double_sided);
  }
  EXPECT_TRUE(load_scene(file, {.both_sides = true})->materials[0].double_sided);
}

TEST(GltfNotes, WarningsAndErrorsStayShortForLongNamesAndUris) {
  GltfMaker maker = GltfMaker::triangle();
  nlohmann::json json = maker.json;
  json["buffers"] = {
      {{"byteLength", 36}, {"uri", "data:nonsense;base64," + std::string(2000000, 'A')}}};
  const std::string data = refusal(text_bytes(json.dump()));
  EXPECT_LT(data.size(), 250u);
  EXPECT_THAT(data, testing::Not(HasSubstr("AAAA")));
  // The name consists of letters of two bytes, which must not be cut in the middle.
  std::string name = "x";
  for (int i = 0; i < 1000; ++i) name += "\xc3\xa9";
  maker.json["meshes"][0]["name"] = name;
  nlohmann::json points = maker.primitive();
  points["mode"] = 0;
  maker.json["meshes"][0]["primitives"].push_back(points);
  const Scene scene = parsed(maker.gltf());
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_LT(scene.warnings[0].size(), 250u);
  EXPECT_THAT(scene.warnings[0],
              testing::AllOf(HasSubstr("\xc3\xa9...\xc3\xa9"), HasSubstr("\" has points")));
  maker.primitive()["attributes"]["POSITION"] = 9;
  const std::string why = refusal(maker.gltf());
  EXPECT_LT(why.size(), 250u);
  EXPECT_THAT(why, testing::EndsWith("accessor 9 does not exist"));
}

// The name of a scene appears in report.json, which must be valid UTF-8.
TEST(GltfNotes, SceneNameIsUtf8ForAnyFileName) {
  const auto scene = parse_gltf(GltfMaker::triangle().gltf(), "caf\xe9.gltf", "");
  ASSERT_TRUE(scene) << scene.error();
  EXPECT_EQ(scene->name, "caf\xef\xbf\xbd");
}

// Names of a mesh, a node, a material and a camera, which four different parts of the loader
// report.
TEST(GltfNotes, NamesFromTheFileAreShortenedToOneShortLine) {
  const std::string name = "a\nb\x1b[31m" + std::string(1000, 'x');
  GltfMaker maker = GltfMaker::triangle();
  maker.json["materials"] = {{{"name", name}, {"alphaMode", "BLEND"}}};
  maker.primitive()["material"] = 0;
  maker.json["meshes"][0]["name"] = name;
  maker.json["cameras"] = {
      {{"name", name}, {"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.5}}}}};
  maker.json["nodes"][0]["camera"] = 0;
  maker.json["nodes"][0]["name"] = name;
  const Scene scene = parsed(maker.gltf());
  ASSERT_EQ(scene.cameras.size(), 1u);
  for (const std::string& told :
       {scene.materials[0].name, scene.meshes[0].name, scene.cameras[0].name}) {
    EXPECT_LT(told.size(), 110u);
    EXPECT_THAT(told, HasSubstr("a b [31mxx"));
  }
  maker.json["nodes"][0]["mesh"] = 9;
  EXPECT_THAT(refusal(maker.gltf()), testing::EndsWith("has no mesh 9"));
}

}  // namespace
}  // namespace alcove::sample
