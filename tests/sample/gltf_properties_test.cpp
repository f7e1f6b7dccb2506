// Tests every property that the loader reads, with values of the right and of the wrong kind. The
// rules are those of glTF 2.0 section 5 and of the extensions' schemas.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <string>
#include <vector>

#include "gltf_maker.h"

namespace alcove::sample {
namespace {

using nlohmann::json;
using testing::HasSubstr;

// A file that has all of these properties, and a valid value for each.
GltfMaker complete() {
  GltfMaker maker = painted({{"index", 0}}, {{"index", 0}, {"scale", 0.5}});
  json& root = maker.json;
  root["asset"]["minVersion"] = "2.0";
  root["extensionsUsed"] = {"KHR_texture_transform"};
  root["extensionsRequired"] = {"KHR_texture_transform"};
  root["samplers"] = {
      {{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", 10497}, {"wrapT", 33071}}};
  root["textures"][0]["sampler"] = 0;
  const json placed = {
      {"index", 0},
      {"texCoord", 0},
      {"extensions",
       {{"KHR_texture_transform",
         {{"offset", {0, 0}}, {"scale", {1, 1}}, {"rotation", 0}, {"texCoord", 1}}}}}};
  root["materials"][0] = {{"name", "tiles"},
                          {"alphaMode", "MASK"},
                          {"alphaCutoff", 0.25},
                          {"doubleSided", true},
                          {"emissiveFactor", {0, 0.5, 1}},
                          {"emissiveTexture", placed},
                          {"normalTexture", {{"index", 0}, {"scale", 0.5}}},
                          {"pbrMetallicRoughness",
                           {{"baseColorFactor", {1, 1, 1, 1}},
                            {"metallicFactor", 0},
                            {"roughnessFactor", 1},
                            {"baseColorTexture", placed},
                            {"metallicRoughnessTexture", placed}}},
                          {"extensions",
                           {{"KHR_materials_emissive_strength", {{"emissiveStrength", 2}}},
                            {"KHR_materials_pbrSpecularGlossiness",
                             {{"diffuseFactor", {1, 1, 1, 1}}, {"diffuseTexture", placed}}}}}};
  const int positions = maker.primitive()["attributes"]["POSITION"];
  root["accessors"][static_cast<size_t>(positions)]["byteOffset"] = 0;
  root["accessors"][static_cast<size_t>(positions)]["sparse"] = {
      {"count", 1},
      {"indices",
       {{"bufferView", maker.view<uint16_t>({0})}, {"byteOffset", 0}, {"componentType", 5123}}},
      {"values", {{"bufferView", maker.view<float>({0, 0, 0})}, {"byteOffset", 0}}}};
  root["bufferViews"][0]["byteStride"] = 12;
  maker.primitive()["indices"] = maker.accessor(maker.view<uint16_t>({0, 1, 2}), 5123, "SCALAR", 3);
  maker.primitive()["mode"] = 4;
  maker.primitive()["targets"] = {json::object()};
  root["meshes"][0]["name"] = "triangle";
  root["nodes"] = {
      {{"mesh", 0}, {"name", "a"}, {"children", {1, 2}}, {"skin", 0}},
      {{"camera", 0}, {"translation", {0, 0, 5}}, {"rotation", {0, 0, 0, 1}}, {"scale", {1, 1, 1}}},
      {{"camera", 1}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}},
      {{"mesh", 0},
       {"extensions",
        {{"KHR_node_visibility", {{"visible", true}}},
         {"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", positions}}}}}}}}};
  root["skins"] = {{{"joints", {1}}, {"skeleton", 0}}};
  root["cameras"] = {
      {{"name", "p"},
       {"type", "perspective"},
       {"perspective", {{"yfov", 1}, {"znear", 0.1}, {"zfar", 10}, {"aspectRatio", 1.5}}}},
      {{"type", "orthographic"},
       {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 10}}}}};
  root["animations"] = json::array();
  return maker;
}

enum class Kind {
  kIndex,
  kNumber,
  kPositive,
  kNumbers,
  kBoolean,
  kString,
  kStrings,
  kIndices,
  kObject,
  kObjects
};

struct Property {
  const char* pointer;  // RFC 6901
  const char* name;     // as the error sentence spells it
  Kind kind;
};
// GoogleTest prints the property in the names that ctest lists.
std::ostream& operator<<(std::ostream& out, const Property& property) {
  return out << property.pointer;
}

std::vector<json> wrong_values(Kind kind) {
  const json too_large = 4294967297u;
  switch (kind) {
    case Kind::kIndex:
      return {-1, -2, 0.5, "0", too_large, 1e300, nullptr, true, {0}};
    case Kind::kNumber:
      return {"1", nullptr, true, json::array({1}), json::object()};
    case Kind::kPositive:
      return {"1", nullptr, true, json::array({1}), -0.5};
    case Kind::kNumbers:
      return {"1", 1, nullptr, json::array({1}), json::array({"0", 1, 1, 1})};
    case Kind::kBoolean:
      return {0, "true", nullptr, json::array()};
    case Kind::kString:
      return {0, nullptr, true, json::array({"a"})};
    case Kind::kStrings:
      return {"a", json::array({1}), json::object(), nullptr};
    case Kind::kIndices:
      return {0,
              "0",
              json::array({-1}),
              json::array({0.5}),
              json::array({"0"}),
              json::array({too_large})};
    case Kind::kObject:
      return {0, "a", json::array(), nullptr};
    case Kind::kObjects:
      return {0, "a", json::object(), json::array({1}), nullptr};
  }
  return {};
}

const Property kProperties[] = {
    {"/asset", "asset", Kind::kObject},
    {"/asset/version", "asset.version", Kind::kString},
    {"/asset/minVersion", "asset.minVersion", Kind::kString},
    {"/extensionsUsed", "extensionsUsed", Kind::kStrings},
    {"/extensionsRequired", "extensionsRequired", Kind::kStrings},
    {"/scene", "scene", Kind::kIndex},
    {"/scenes", "scenes", Kind::kObjects},
    {"/scenes/0/nodes", "scenes[0].nodes", Kind::kIndices},
    {"/nodes", "nodes", Kind::kObjects},
    {"/nodes/0/name", "nodes[0].name", Kind::kString},
    {"/nodes/0/children", "nodes[0].children", Kind::kIndices},
    {"/nodes/0/mesh", "nodes[0].mesh", Kind::kIndex},
    {"/nodes/0/skin", "nodes[0].skin", Kind::kIndex},
    {"/nodes/1/camera", "nodes[1].camera", Kind::kIndex},
    {"/nodes/2/matrix", "nodes[2].matrix", Kind::kNumbers},
    {"/nodes/1/translation", "nodes[1].translation", Kind::kNumbers},
    {"/nodes/1/rotation", "nodes[1].rotation", Kind::kNumbers},
    {"/nodes/1/scale", "nodes[1].scale", Kind::kNumbers},
    {"/nodes/3/extensions", "nodes[3].extensions", Kind::kObject},
    {"/nodes/3/extensions/EXT_mesh_gpu_instancing", "nodes[3].extensions.EXT_mesh_gpu_instancing",
     Kind::kObject},
    {"/nodes/3/extensions/EXT_mesh_gpu_instancing/attributes",
     "nodes[3].extensions.EXT_mesh_gpu_instancing.attributes", Kind::kObject},
    {"/nodes/3/extensions/EXT_mesh_gpu_instancing/attributes/TRANSLATION",
     "nodes[3].extensions.EXT_mesh_gpu_instancing.attributes.TRANSLATION", Kind::kIndex},
    {"/nodes/3/extensions/KHR_node_visibility/visible",
     "nodes[3].extensions.KHR_node_visibility.visible", Kind::kBoolean},
    {"/meshes", "meshes", Kind::kObjects},
    {"/meshes/0/name", "meshes[0].name", Kind::kString},
    {"/meshes/0/primitives", "meshes[0].primitives", Kind::kObjects},
    {"/meshes/0/primitives/0/attributes", "meshes[0].primitives[0].attributes", Kind::kObject},
    {"/meshes/0/primitives/0/attributes/POSITION", "meshes[0].primitives[0].attributes.POSITION",
     Kind::kIndex},
    {"/meshes/0/primitives/0/indices", "meshes[0].primitives[0].indices", Kind::kIndex},
    {"/meshes/0/primitives/0/material", "meshes[0].primitives[0].material", Kind::kIndex},
    {"/meshes/0/primitives/0/mode", "meshes[0].primitives[0].mode", Kind::kIndex},
    {"/meshes/0/primitives/0/targets", "meshes[0].primitives[0].targets", Kind::kObjects},
    {"/skins", "skins", Kind::kObjects},
    {"/skins/0/joints", "skins[0].joints", Kind::kIndices},
    {"/skins/0/skeleton", "skins[0].skeleton", Kind::kIndex},
    {"/accessors", "accessors", Kind::kObjects},
    {"/accessors/0/bufferView", "accessors[0].bufferView", Kind::kIndex},
    {"/accessors/0/componentType", "accessors[0].componentType", Kind::kIndex},
    {"/accessors/0/normalized", "accessors[0].normalized", Kind::kBoolean},
    {"/accessors/0/type", "accessors[0].type", Kind::kString},
    {"/accessors/0/sparse", "accessors[0].sparse", Kind::kObject},
    {"/accessors/0/sparse/count", "accessors[0].sparse.count", Kind::kIndex},
    {"/accessors/0/sparse/indices", "accessors[0].sparse.indices", Kind::kObject},
    {"/accessors/0/sparse/indices/bufferView", "accessors[0].sparse.indices.bufferView",
     Kind::kIndex},
    {"/accessors/0/sparse/indices/byteOffset", "accessors[0].sparse.indices.byteOffset",
     Kind::kIndex},
    {"/accessors/0/sparse/indices/componentType", "accessors[0].sparse.indices.componentType",
     Kind::kIndex},
    {"/accessors/0/sparse/values", "accessors[0].sparse.values", Kind::kObject},
    {"/accessors/0/sparse/values/bufferView", "accessors[0].sparse.values.bufferView",
     Kind::kIndex},
    {"/accessors/0/sparse/values/byteOffset", "accessors[0].sparse.values.byteOffset",
     Kind::kIndex},
    {"/bufferViews", "bufferViews", Kind::kObjects},
    {"/bufferViews/0/buffer", "bufferViews[0].buffer", Kind::kIndex},
    {"/bufferViews/0/byteStride", "bufferViews[0].byteStride", Kind::kIndex},
    {"/images", "images", Kind::kObjects},
    {"/images/0/bufferView", "images[0].bufferView", Kind::kIndex},
    {"/images/0/mimeType", "images[0].mimeType", Kind::kString},
    {"/textures", "textures", Kind::kObjects},
    {"/textures/0/source", "textures[0].source", Kind::kIndex},
    {"/textures/0/sampler", "textures[0].sampler", Kind::kIndex},
    {"/samplers", "samplers", Kind::kObjects},
    {"/samplers/0/magFilter", "samplers[0].magFilter", Kind::kIndex},
    {"/samplers/0/minFilter", "samplers[0].minFilter", Kind::kIndex},
    {"/samplers/0/wrapS", "samplers[0].wrapS", Kind::kIndex},
    {"/samplers/0/wrapT", "samplers[0].wrapT", Kind::kIndex},
    {"/materials", "materials", Kind::kObjects},
    {"/materials/0/name", "materials[0].name", Kind::kString},
    {"/materials/0/alphaMode", "materials[0].alphaMode", Kind::kString},
    {"/materials/0/alphaCutoff", "materials[0].alphaCutoff", Kind::kPositive},
    {"/materials/0/doubleSided", "materials[0].doubleSided", Kind::kBoolean},
    {"/materials/0/emissiveFactor", "materials[0].emissiveFactor", Kind::kNumbers},
    {"/materials/0/emissiveTexture", "materials[0].emissiveTexture", Kind::kObject},
    {"/materials/0/normalTexture", "materials[0].normalTexture", Kind::kObject},
    {"/materials/0/normalTexture/index", "materials[0].normalTexture.index", Kind::kIndex},
    {"/materials/0/normalTexture/scale", "materials[0].normalTexture.scale", Kind::kNumber},
    {"/materials/0/emissiveTexture/texCoord", "materials[0].emissiveTexture.texCoord",
     Kind::kIndex},
    {"/materials/0/emissiveTexture/extensions/KHR_texture_transform",
     "materials[0].emissiveTexture.extensions.KHR_texture_transform", Kind::kObject},
    {"/materials/0/emissiveTexture/extensions/KHR_texture_transform/offset",
     "materials[0].emissiveTexture.extensions.KHR_texture_transform.offset", Kind::kNumbers},
    {"/materials/0/emissiveTexture/extensions/KHR_texture_transform/scale",
     "materials[0].emissiveTexture.extensions.KHR_texture_transform.scale", Kind::kNumbers},
    {"/materials/0/emissiveTexture/extensions/KHR_texture_transform/rotation",
     "materials[0].emissiveTexture.extensions.KHR_texture_transform.rotation", Kind::kNumber},
    {"/materials/0/emissiveTexture/extensions/KHR_texture_transform/texCoord",
     "materials[0].emissiveTexture.extensions.KHR_texture_transform.texCoord", Kind::kIndex},
    {"/materials/0/pbrMetallicRoughness", "materials[0].pbrMetallicRoughness", Kind::kObject},
    {"/materials/0/pbrMetallicRoughness/baseColorFactor",
     "materials[0].pbrMetallicRoughness.baseColorFactor", Kind::kNumbers},
    {"/materials/0/pbrMetallicRoughness/metallicFactor",
     "materials[0].pbrMetallicRoughness.metallicFactor", Kind::kPositive},
    {"/materials/0/pbrMetallicRoughness/roughnessFactor",
     "materials[0].pbrMetallicRoughness.roughnessFactor", Kind::kPositive},
    {"/materials/0/pbrMetallicRoughness/baseColorTexture/index",
     "materials[0].pbrMetallicRoughness.baseColorTexture.index", Kind::kIndex},
    {"/materials/0/pbrMetallicRoughness/metallicRoughnessTexture/index",
     "materials[0].pbrMetallicRoughness.metallicRoughnessTexture.index", Kind::kIndex},
    {"/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength",
     "materials[0].extensions.KHR_materials_emissive_strength.emissiveStrength", Kind::kPositive},
    {"/materials/0/extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor",
     "materials[0].extensions.KHR_materials_pbrSpecularGlossiness.diffuseFactor", Kind::kNumbers},
    {"/materials/0/extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture/index",
     "materials[0].extensions.KHR_materials_pbrSpecularGlossiness.diffuseTexture.index",
     Kind::kIndex},
    {"/cameras", "cameras", Kind::kObjects},
    {"/cameras/0/name", "cameras[0].name", Kind::kString},
    {"/cameras/0/type", "cameras[0].type", Kind::kString},
    {"/cameras/0/perspective", "cameras[0].perspective", Kind::kObject},
    {"/cameras/0/perspective/yfov", "cameras[0].perspective.yfov", Kind::kPositive},
    {"/cameras/0/perspective/znear", "cameras[0].perspective.znear", Kind::kPositive},
    {"/cameras/0/perspective/zfar", "cameras[0].perspective.zfar", Kind::kPositive},
    {"/cameras/1/orthographic", "cameras[1].orthographic", Kind::kObject},
    {"/cameras/1/orthographic/ymag", "cameras[1].orthographic.ymag", Kind::kNumber},
    {"/cameras/1/orthographic/znear", "cameras[1].orthographic.znear", Kind::kPositive},
    {"/cameras/1/orthographic/zfar", "cameras[1].orthographic.zfar", Kind::kPositive},
    {"/animations", "animations", Kind::kObjects},
};

class GltfProperty : public testing::TestWithParam<Property> {};

// Reads the valid value of complete(). An integer such as 4 may also be written as 4.0.
TEST_P(GltfProperty, ValidValueOfThePropertyIsRead) {
  const json::json_pointer pointer(GetParam().pointer);
  GltfMaker maker = complete();
  const Scene expected = parsed(maker.gltf());
  ASSERT_TRUE(maker.json.contains(pointer));
  json& value = maker.json[pointer];
  if (value.is_number_integer()) value = static_cast<double>(value.get<int>());
  const Scene scene = parsed(maker.gltf());
  EXPECT_EQ(corners(scene), corners(expected));
  EXPECT_EQ(scene.warnings, expected.warnings);
  EXPECT_EQ(scene.cameras.size(), expected.cameras.size());
}

TEST_P(GltfProperty, WrongValuesOfThePropertyAreRefusedWithItsName) {
  for (const json& wrong : wrong_values(GetParam().kind)) {
    GltfMaker maker = complete();
    maker.json[json::json_pointer(GetParam().pointer)] = wrong;
    const std::string sentence = refusal(maker.gltf());
    EXPECT_THAT(sentence, HasSubstr(std::string(" ") + GetParam().name)) << wrong;
    EXPECT_THAT(sentence, HasSubstr("must be")) << wrong;
  }
}

std::string test_name(const testing::TestParamInfo<Property>& info) {
  std::string name = info.param.pointer + 1;
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, GltfProperty, testing::ValuesIn(kProperties), test_name);

TEST(GltfProperties, WrongLengthAndUriOfABufferAreRefused) {
  const GltfMaker maker = GltfMaker::triangle();
  const auto with = [&](const char* member, const json& value) {
    json root = json::parse(maker.gltf());
    root["buffers"][0][member] = value;
    const std::string text = root.dump();
    return refusal({text.begin(), text.end()});
  };
  EXPECT_THAT(with("byteLength", -1), HasSubstr("buffers[0].byteLength is -1"));
  EXPECT_THAT(with("byteLength", "36"), HasSubstr("buffers[0].byteLength is \"36\""));
  EXPECT_THAT(with("byteLength", 1e300), HasSubstr("buffers[0].byteLength is 1e+300"));
  EXPECT_THAT(with("uri", 5), HasSubstr("buffers[0].uri is 5; it must be a string"));
}

TEST(GltfProperties, ErrorForAMissingRequiredPropertyNamesTheProperty) {
  const std::pair<const char*, const char*> missing[] = {
      {"/asset", "asset is missing"},
      {"/asset/version", "asset.version is missing"},
      {"/accessors/0/count", "accessors[0].count is missing"},
      {"/accessors/0/type", "accessors[0].type is missing"},
      {"/accessors/0/sparse/values", "accessors[0].sparse.values is missing"},
      {"/bufferViews/0/buffer", "bufferViews[0].buffer is missing"},
      {"/bufferViews/0/byteLength", "bufferViews[0].byteLength is missing"},
      {"/meshes/0/primitives", "meshes[0].primitives is missing"},
      {"/materials/0/normalTexture/index", "materials[0].normalTexture.index is missing"},
      {"/cameras/0/type", "cameras[0].type is missing"},
      {"/skins/0/joints", "skins[0].joints is missing"},
  };
  for (const auto& [pointer, sentence] : missing) {
    GltfMaker maker = complete();
    const json::json_pointer where(pointer);
    maker.json[where.parent_pointer()].erase(where.back());
    EXPECT_THAT(refusal(maker.gltf()), HasSubstr(sentence));
  }
}

TEST(GltfProperties, UnknownEnumerationValueIsRefusedWithTheNameOfTheProperty) {
  const std::pair<const char*, const char*> wrong[] = {
      {"/accessors/0/type", "accessors[0].type is \"VEC\"; it must be one of SCALAR, VEC2"},
      {"/materials/0/alphaMode", "materials[0].alphaMode is \"VEC\""},
      {"/cameras/0/type", "cameras[0].type is \"VEC\""}};
  for (const auto& [pointer, sentence] : wrong) {
    GltfMaker maker = complete();
    maker.json[json::json_pointer(pointer)] = "VEC";
    EXPECT_THAT(refusal(maker.gltf()), HasSubstr(sentence));
  }
}

// Extras and unknown extensions may hold anything.
TEST(GltfProperties, PropertiesThatTheLoaderDoesNotReadAreNotChecked) {
  GltfMaker maker = complete();
  maker.json["extras"] = {{"nodes", -5}};
  maker.json["nodes"][0]["extras"] = "text";
  maker.json["nodes"][0]["extensions"] = {{"MY_extension", {{"mesh", -1.5}}}};
  maker.json["animations"] = {{{"channels", "?"}}};
  maker.json["materials"][0]["occlusionTexture"] = "?";
  maker.json["extensions"] = {{"KHR_lights_punctual", {{"lights", 7}}}};
  const Scene scene = parsed(maker.gltf());
  EXPECT_THAT(scene.warnings, testing::Contains(HasSubstr("Animations are left out")));
}

TEST(GltfProperties, JsonNestedAMillionLevelsDeepIsRead) {
  const GltfMaker maker = GltfMaker::triangle();
  const std::vector<uint8_t> gltf = maker.gltf();
  std::string text(gltf.begin(), gltf.end() - 1);
  text += ",\"extras\":" + std::string(1'000'000, '[') + std::string(1'000'000, ']') + "}";
  EXPECT_EQ(corners(parsed({text.begin(), text.end()})), corners(parsed(gltf)));
}

TEST(GltfProperties, ErrorForDamagedJsonGivesTheBytePositionOfTheFault) {
  const std::string text = R"({"asset": {"version": "2.0"}, "nodes": [}])";
  EXPECT_THAT(refusal({text.begin(), text.end()}), HasSubstr("cannot be read at byte 41"));
  const std::string number = R"({"asset": {"version": "2.0"}, "scene": 1e999})";
  EXPECT_THAT(refusal({number.begin(), number.end()}), HasSubstr("a number that is too large"));
}

}  // namespace
}  // namespace alcove::sample
