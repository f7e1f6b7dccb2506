// Tests the limits on memory and time. Small files that name the same data many times reach them,
// because data counts once for each use.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "gltf_maker.h"

namespace alcove::sample {
namespace {

using testing::HasSubstr;

// Repeats the first node of a file.
void repeat_node(GltfMaker& maker, size_t count) {
  const nlohmann::json node = maker.json["nodes"][0];
  maker.json["nodes"] = nlohmann::json(count, node);
  for (size_t i = 0; i < count; ++i) maker.json["scenes"][0]["nodes"][i] = i;
}

// A triangle that `nodes` nodes show, whose mesh has `primitives` primitives.
GltfMaker repeated_triangle(size_t nodes, size_t primitives) {
  GltfMaker maker = GltfMaker::triangle();
  const nlohmann::json primitive = maker.primitive();
  maker.json["meshes"][0]["primitives"] = nlohmann::json(primitives, primitive);
  repeat_node(maker, nodes);
  return maker;
}

// A triangle that follows one joint, with `sets` sets of joints and weights.
GltfMaker skinned_triangle(int sets) {
  GltfMaker maker = GltfMaker::triangle();
  const int joints = maker.add<uint8_t>("VEC4", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  const int weights = maker.add<float>("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  for (int set = 0; set < sets; ++set) {
    maker.primitive()["attributes"]["JOINTS_" + std::to_string(set)] = joints;
    maker.primitive()["attributes"]["WEIGHTS_" + std::to_string(set)] = weights;
  }
  maker.json["skins"] = {{{"joints", {0, 0, 0}}}};
  maker.json["nodes"][0]["skin"] = 0;
  return maker;
}

GltfMaker repeated_skin() {
  GltfMaker maker = skinned_triangle(1);
  repeat_node(maker, 20);
  return maker;
}

// A triangle with an area, and one without, which takes as long to read.
GltfMaker flat_triangle(bool indexed) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["accessors"].push_back({{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
  nlohmann::json flat = {{"attributes", {{"POSITION", 1}}}};
  if (indexed) flat["indices"] = maker.add<uint16_t>("SCALAR", {0, 1, 2});
  maker.json["meshes"][0]["primitives"].push_back(flat);
  return maker;
}

GltfMaker triangle_and_lines() {
  GltfMaker maker = repeated_triangle(1, 101);
  for (size_t i = 1; i < 101; ++i) maker.json["meshes"][0]["primitives"][i]["mode"] = 1;
  return maker;
}

// A file that a limit of `enough` just admits, and a part of the sentence that refuses it below.
struct Limit {
  const char* name;
  GltfMaker maker;
  uint64_t GltfLimits::*limit;
  uint64_t enough;
  const char* word;
};
const Limit kLimits[] = {
    {"InstancesOnceForEachPrimitive", repeated_triangle(10, 4), &GltfLimits::instances, 40,
     "past the number of instances"},
    {"SetsOfJointsAsVertices", skinned_triangle(2), &GltfLimits::vertices, 9,
     "too many joints and weights: 2 sets for 3 vertices"},
    {"JointsOnceForEachSkin", repeated_skin(), &GltfLimits::joints, 3, "past the number of joints"},
    {"TrianglesOnceForEachInstance", repeated_triangle(100, 1), &GltfLimits::drawn_triangles, 100,
     "instances counted each"},
    {"TrianglesWithoutArea", flat_triangle(false), &GltfLimits::drawn_triangles, 2,
     "past the number of triangles"},
    {"IndexedTrianglesWithoutArea", flat_triangle(true), &GltfLimits::drawn_triangles, 2,
     "past the number of triangles"},
    {"PrimitivesThatAreNotTriangles", triangle_and_lines(), &GltfLimits::primitives, 101, "parts"},
    {"Vertices", repeated_triangle(1, 3), &GltfLimits::vertices, 9, "too many vertices"},
    {"Indices", flat_triangle(true), &GltfLimits::indices, 6, "too many elements"},
};

TEST(GltfLimit, FileIsReadUpToTheLimitAndRefusedBeyondIt) {
  for (const auto& [name, maker, limit, enough, word] : kLimits) {
    SCOPED_TRACE(name);
    GltfLimits limits;
    limits.*limit = enough;
    parsed(maker.gltf(), limits);
    --(limits.*limit);
    EXPECT_THAT(refusal(maker.gltf(), limits), HasSubstr(word));
  }
}

// 5 * 10^8 uses of primitives would take 16 GB.
TEST(GltfRepeatedData, FileWithHalfABillionInstancesIsRefused) {
  EXPECT_THAT(refusal(repeated_triangle(50'000, 10'000).gltf()),
              HasSubstr("past the number of instances"));
}

TEST(GltfRepeatedData, OnlyTheVerticesThatIndicesUseAreReadAndKept) {
  GltfMaker maker = GltfMaker::triangle();
  // A zero-filled accessor of 67 million elements, of which three have values.
  maker.json["accessors"][0].erase("bufferView");
  maker.json["accessors"][0]["count"] = 67'000'000;
  maker.json["accessors"][0]["sparse"] = {
      {"count", 3},
      {"indices",
       {{"bufferView", maker.view<uint32_t>({5, 6, 66'999'999})}, {"componentType", 5125}}},
      {"values", {{"bufferView", 0}}}};
  maker.primitive()["indices"] = maker.add<uint32_t>("SCALAR", {66'999'999, 5, 6});
  GltfLimits limits;
  limits.vertices = 3;
  const Scene scene = parsed(maker.gltf(), limits);
  ASSERT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.meshes[0].positions.size(), 3u);
  EXPECT_THAT(corners(scene),
              testing::ElementsAre(glm::vec3(0, 1, 0), glm::vec3(0, 0, 0), glm::vec3(1, 0, 0)));
}

TEST(GltfRepeatedData, UnusedVerticesNeedNotBeFiniteAndDoNotExtendTheScene) {
  GltfMaker maker = GltfMaker::triangle();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  maker.primitive()["attributes"]["POSITION"] =
      maker.add<float>("VEC3", {nan, nan, nan, 0, 0, 0, 1, 0, 0, 0, 1, 0, 1e6, 0, 0});
  maker.primitive()["indices"] = maker.add<uint16_t>("SCALAR", {1, 2, 3});
  const Scene scene = parsed(maker.gltf());
  EXPECT_EQ(scene.bounds_ws.low, glm::vec3(0));
  EXPECT_EQ(scene.bounds_ws.high, glm::vec3(1, 1, 0));
}

TEST(GltfRepeatedData, VerticesWithoutDataAndWithoutIndicesAreLimited) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["accessors"][0].erase("bufferView");
  maker.json["accessors"][0]["count"] = 60'000'000;
  EXPECT_THAT(refusal(maker.gltf()), HasSubstr("has too many vertices: 60000000"));
}

TEST(GltfRepeatedData, EmptyEmbeddedImageIsLeftOutWithAWarning) {
  GltfMaker maker = painted({{"index", 0}}, {{"index", 0}});
  maker.json["images"][0] = {{"uri", "data:image/png;base64,"}};
  EXPECT_THAT(parsed(maker.gltf()).warnings,
              testing::Contains("image 0 (data:...) is empty and is left out."));
}

TEST(GltfRepeatedData, ErrorForAnEmptyFileSaysThatTheFileIsEmpty) {
  EXPECT_EQ(refusal({}), "cannot read test.gltf: it is empty");
}

}  // namespace
}  // namespace alcove::sample
