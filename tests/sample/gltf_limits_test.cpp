// Tests the limits on memory and time. Small files that name the same data many times reach them,
// because data counts once for each use.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <ostream>
#include <string>

#include "gltf_maker.h"

namespace alcove::sample {
namespace {

using testing::HasSubstr;

// A triangle that `nodes` nodes show, whose mesh has `primitives` primitives.
GltfMaker repeated_triangle(int nodes, int primitives) {
  GltfMaker maker = GltfMaker::triangle();
  const nlohmann::json primitive = maker.primitive();
  maker.json["meshes"][0]["primitives"] =
      nlohmann::json(static_cast<size_t>(primitives), primitive);
  maker.json["nodes"] = nlohmann::json(static_cast<size_t>(nodes), {{"mesh", 0}});
  for (int i = 0; i < nodes; ++i) maker.json["scenes"][0]["nodes"][static_cast<size_t>(i)] = i;
  return maker;
}

// A triangle that follows one joint, with `sets` sets of joints and weights.
GltfMaker skinned_triangle(int sets) {
  GltfMaker maker = GltfMaker::triangle();
  const int joints =
      maker.accessor(maker.view<uint8_t>({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}), 5121, "VEC4", 3);
  const int weights =
      maker.accessor(maker.view<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), 5126, "VEC4", 3);
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
  const nlohmann::json node = maker.json["nodes"][0];
  maker.json["nodes"] = nlohmann::json(20, node);
  for (size_t i = 0; i < 20; ++i) maker.json["scenes"][0]["nodes"][i] = i;
  return maker;
}

// A triangle with an area, and one without, which takes as long to read.
GltfMaker flat_triangle(bool indexed) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["accessors"].push_back({{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
  nlohmann::json flat = {{"attributes", {{"POSITION", 1}}}};
  if (indexed) flat["indices"] = maker.accessor(maker.view<uint16_t>({0, 1, 2}), 5123, "SCALAR", 3);
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
std::ostream& operator<<(std::ostream& out, const Limit& limit) { return out << limit.name; }

class GltfLimit : public testing::TestWithParam<Limit> {};

TEST_P(GltfLimit, FileIsReadUpToTheLimitAndRefusedBeyondIt) {
  const Limit& limit = GetParam();
  GltfLimits limits;
  limits.*limit.limit = limit.enough;
  EXPECT_TRUE(parse_gltf(limit.maker.gltf(), "limit.gltf", "", limits));
  --(limits.*limit.limit);
  const auto scene = parse_gltf(limit.maker.gltf(), "limit.gltf", "", limits);
  ASSERT_FALSE(scene);
  EXPECT_THAT(scene.error(), HasSubstr(limit.word));
}

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
INSTANTIATE_TEST_SUITE_P(All, GltfLimit, testing::ValuesIn(kLimits),
                         [](const auto& param) { return std::string(param.param.name); });

// 5 * 10^8 uses of primitives would take 16 GB.
TEST(GltfRepeatedData, FileWithHalfABillionInstancesIsRefused) {
  const auto scene = parse_gltf(repeated_triangle(50'000, 10'000).gltf(), "repeated.gltf", "");
  ASSERT_FALSE(scene);
  EXPECT_THAT(scene.error(), HasSubstr("past the number of instances"));
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
  maker.primitive()["indices"] =
      maker.accessor(maker.view<uint32_t>({66'999'999, 5, 6}), 5125, "SCALAR", 3);
  GltfLimits limits;
  limits.vertices = 3;
  const auto scene = parse_gltf(maker.gltf(), "sparse.gltf", "", limits);
  ASSERT_TRUE(scene) << scene.error();
  EXPECT_EQ(scene->meshes[0].positions.size(), 3u);
  EXPECT_THAT(corners(*scene),
              testing::ElementsAre(glm::vec3(0, 1, 0), glm::vec3(0, 0, 0), glm::vec3(1, 0, 0)));
}

TEST(GltfRepeatedData, UnusedVerticesNeedNotBeFiniteAndDoNotExtendTheScene) {
  GltfMaker maker = GltfMaker::triangle();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const int positions = maker.view<float>({nan, nan, nan, 0, 0, 0, 1, 0, 0, 0, 1, 0, 1e6, 0, 0});
  maker.primitive()["attributes"]["POSITION"] = maker.accessor(positions, 5126, "VEC3", 5);
  maker.primitive()["indices"] = maker.accessor(maker.view<uint16_t>({1, 2, 3}), 5123, "SCALAR", 3);
  const Scene scene = parsed(maker.gltf());
  EXPECT_EQ(scene.bounds_ws.low, glm::vec3(0));
  EXPECT_EQ(scene.bounds_ws.high, glm::vec3(1, 1, 0));
}

TEST(GltfRepeatedData, VerticesWithoutDataAndWithoutIndicesAreLimited) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["accessors"][0].erase("bufferView");
  maker.json["accessors"][0]["count"] = 60'000'000;
  const auto scene = parse_gltf(maker.gltf(), "many.gltf", "");
  ASSERT_FALSE(scene);
  EXPECT_THAT(scene.error(), HasSubstr("has too many vertices: 60000000"));
}

TEST(GltfRepeatedData, EmptyEmbeddedImageIsLeftOutWithAWarning) {
  GltfMaker maker = painted({{"index", 0}}, {{"index", 0}});
  maker.json["images"][0] = {{"uri", "data:image/png;base64,"}};
  EXPECT_THAT(parsed(maker.gltf()).warnings,
              testing::Contains("image 0 (data:...) is empty and is left out."));
}

TEST(GltfRepeatedData, ErrorForAnEmptyFileSaysThatTheFileIsEmpty) {
  const auto scene = parse_gltf({}, "empty.gltf", "");
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error(), "cannot read empty.gltf: it is empty");
}

}  // namespace
}  // namespace alcove::sample
