// Tests every property that the loader reads, with values of the right and of the wrong kind. The
// rules are those of glTF 2.0 section 5 and of the extensions' schemas.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <string>
#include <vector>

#include "gltf_maker.h"

namespace alcove::sample {
namespace {

using nlohmann::json;
using testing::HasSubstr;

// A file that has the properties that the loader reads, and a valid value for each. A number that
// need not be whole has a fraction, by which the tests tell it from an index.
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
         {{"offset", {0.0, 0.0}}, {"scale", {1.0, 1.0}}, {"rotation", 0.0}, {"texCoord", 1}}}}}};
  root["materials"][0] = {
      {"name", "tiles"},
      {"alphaMode", "MASK"},
      {"alphaCutoff", 0.25},
      {"doubleSided", true},
      {"emissiveFactor", {0.0, 0.5, 1.0}},
      {"emissiveTexture", placed},
      {"normalTexture", {{"index", 0}, {"scale", 0.5}}},
      {"pbrMetallicRoughness",
       {{"baseColorFactor", {1.0, 1.0, 1.0, 1.0}},
        {"metallicFactor", 0.0},
        {"roughnessFactor", 1.0},
        {"baseColorTexture", placed},
        {"metallicRoughnessTexture", placed}}},
      {"extensions",
       {{"KHR_materials_emissive_strength", {{"emissiveStrength", 2.0}}},
        {"KHR_materials_pbrSpecularGlossiness",
         {{"diffuseFactor", {1.0, 1.0, 1.0, 1.0}}, {"diffuseTexture", placed}}}}}};
  const int positions = maker.primitive()["attributes"]["POSITION"];
  root["accessors"][static_cast<size_t>(positions)]["byteOffset"] = 0;
  root["accessors"][static_cast<size_t>(positions)]["sparse"] = {
      {"count", 1},
      {"indices",
       {{"bufferView", maker.view<uint16_t>({0})}, {"byteOffset", 0}, {"componentType", 5123}}},
      {"values", {{"bufferView", maker.view<float>({0, 0, 0})}, {"byteOffset", 0}}}};
  root["bufferViews"][0]["byteStride"] = 12;
  maker.primitive()["indices"] = maker.add<uint16_t>("SCALAR", {0, 1, 2});
  maker.primitive()["mode"] = 4;
  maker.primitive()["targets"] = {json::object()};
  root["meshes"][0]["name"] = "triangle";
  root["nodes"] = {
      {{"mesh", 0}, {"name", "a"}, {"children", {1, 2}}, {"skin", 0}},
      {{"camera", 0},
       {"translation", {0.0, 0.0, 5.0}},
       {"rotation", {0.0, 0.0, 0.0, 1.0}},
       {"scale", {1.0, 1.0, 1.0}}},
      {{"camera", 1},
       {"matrix",
        {1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0}}},
      {{"mesh", 0},
       {"extensions",
        {{"KHR_node_visibility", {{"visible", true}}},
         {"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", positions}}}}}}}}};
  root["skins"] = {{{"joints", {1}}, {"skeleton", 0}}};
  root["cameras"] = {
      {{"name", "p"},
       {"type", "perspective"},
       {"perspective", {{"yfov", 1.0}, {"znear", 0.1}, {"zfar", 10.0}, {"aspectRatio", 1.5}}}},
      {{"type", "orthographic"},
       {"orthographic", {{"xmag", 1.0}, {"ymag", 1.0}, {"znear", 0.0}, {"zfar", 10.0}}}}};
  root["animations"] = json::array();
  return maker;
}

struct Property {
  json::json_pointer pointer;
  std::string name;  // as the error sentence spells it
};

// Finds the properties below a member or element, except the single numbers and strings of arrays.
void add_properties(const json& value, const Property& at, std::vector<Property>& out) {
  out.push_back(at);
  for (const auto& [key, child] : value.items()) {
    if (value.is_object()) add_properties(child, {at.pointer / key, at.name + "." + key}, out);
    if (!value.is_array() || !child.is_object()) continue;
    const size_t index = std::stoul(key);
    for (const auto& [name, member] : child.items())
      add_properties(member, {at.pointer / index / name, at.name + "[" + key + "]." + name}, out);
  }
}

std::vector<Property> all_properties() {
  std::vector<Property> out;
  const json root = complete().json;
  for (const auto& [name, value] : root.items())
    add_properties(value, {json::json_pointer() / name, name}, out);
  return out;
}

// Returns values of other types or out of range, for a property with a valid value.
std::vector<json> wrong_values(const json& valid, const std::string& name) {
  const json too_large = 4294967297u;
  if (valid.is_object()) return {0, "a", json::array(), nullptr};
  if (valid.is_string()) return {0, nullptr, true, json::array({"a"})};
  if (valid.is_boolean()) return {0, "true", nullptr, json::array()};
  if (valid.is_number_integer()) {
    std::vector<json> out = {-1, -2, 0.5, "0", 1e300, nullptr, true, json::array({0})};
    // Sizes and offsets may be larger than an index.
    if (!std::regex_search(name, std::regex("accessors.*[.]count|[.]byte(Offset|Length)$")))
      out.push_back(too_large);
    return out;
  }
  if (valid.is_number()) {
    std::vector<json> out = {"1", nullptr, true, json::array({1}), json::object()};
    const std::regex not_negative("Factor$|Strength$|Cutoff$|yfov$|znear$|zfar$");
    if (std::regex_search(name, not_negative)) out.push_back(-0.5);
    return out;
  }
  if (valid.empty() || valid[0].is_object())
    return {0, "a", json::object(), json::array({1}), nullptr};
  if (valid[0].is_string()) return {"a", json::array({1}), json::object(), nullptr};
  if (valid[0].is_number_integer()) {
    return {0,
            "0",
            json::array({-1}),
            json::array({0.5}),
            json::array({"0"}),
            json::array({too_large})};
  }
  return {"1", 1, nullptr, json::array({1}), json::array({"0", 1, 1, 1})};
}

// An integer such as 4 may also be written as 4.0.
TEST(GltfProperties, WholeNumbersMayHaveAFraction) {
  const Scene expected = parsed(complete().gltf());
  for (const Property& property : all_properties()) {
    GltfMaker maker = complete();
    json& value = maker.json[property.pointer];
    if (!value.is_number_integer()) continue;
    SCOPED_TRACE(property.name);
    value = static_cast<double>(value.get<int>());
    const Scene scene = parsed(maker.gltf());
    EXPECT_EQ(corners(scene), corners(expected));
    EXPECT_EQ(scene.warnings, expected.warnings);
    EXPECT_EQ(scene.cameras.size(), expected.cameras.size());
  }
}

TEST(GltfProperties, WrongValuesOfAPropertyAreRefusedWithItsName) {
  const std::vector<Property> properties = all_properties();
  EXPECT_GT(properties.size(), 110u);
  const GltfMaker valid = complete();
  for (const Property& property : properties) {
    for (const json& wrong : wrong_values(valid.json[property.pointer], property.name)) {
      GltfMaker maker = valid;
      maker.json[property.pointer] = wrong;
      SCOPED_TRACE(testing::Message() << property.name << " " << wrong);
      const std::string sentence = refusal(maker.gltf());
      EXPECT_THAT(sentence, HasSubstr(" " + property.name));
      EXPECT_THAT(sentence, HasSubstr("must be"));
    }
  }
}

TEST(GltfProperties, WrongLengthAndUriOfABufferAreRefused) {
  const GltfMaker maker = GltfMaker::triangle();
  const auto with = [&](const char* member, const json& value) {
    json root = json::parse(maker.gltf());
    root["buffers"][0][member] = value;
    return refusal(text_bytes(root.dump()));
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
  EXPECT_TRUE(scene.has_animations);
  EXPECT_THAT(scene.warnings, testing::Contains(HasSubstr("Animations are left out")));
}

TEST(GltfProperties, JsonNestedAMillionLevelsDeepIsRead) {
  const GltfMaker maker = GltfMaker::triangle();
  const std::vector<uint8_t> gltf = maker.gltf();
  std::string text(gltf.begin(), gltf.end() - 1);
  text += ",\"extras\":" + std::string(1'000'000, '[') + std::string(1'000'000, ']') + "}";
  EXPECT_EQ(corners(parsed(text_bytes(text))), corners(parsed(gltf)));
}

TEST(GltfProperties, ErrorForDamagedJsonGivesTheBytePositionOfTheFault) {
  const std::string text = R"({"asset": {"version": "2.0"}, "nodes": [}])";
  EXPECT_THAT(refusal(text_bytes(text)), HasSubstr("cannot be read at byte 41"));
  const std::string number = R"({"asset": {"version": "2.0"}, "scene": 1e999})";
  EXPECT_THAT(refusal(text_bytes(number)), HasSubstr("a number that is too large"));
}

}  // namespace
}  // namespace alcove::sample
