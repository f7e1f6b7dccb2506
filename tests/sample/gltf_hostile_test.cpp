// Files that are invalid, truncated or too large.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gltf_maker.h"
#include "image_maker.h"

namespace alcove::sample {
namespace {

using nlohmann::literals::operator""_json;  // NOLINT(misc-unused-using-decls)
using testing::HasSubstr;

// A value that makes a file invalid if the member of its JSON at the pointer has it, and a part of
// the sentence that refuses the file.
struct Fault {
  const char *pointer, *value, *sentence;
};
const Fault kFaults[] = {
    {"/accessors/0/count", "4000000000", "too many vertices"},
    {"/accessors/0/count", "4", "past the end"},
    {"/accessors/0/byteOffset", "4294967000", "past the end"},
    {"/bufferViews/0/byteLength", "1000", "buffer view 0"},
    {"/accessors/0/bufferView", "77", "buffer view"},
    {"/bufferViews/0/buffer", "9", "buffer"},
    {"/meshes/0/primitives/0/attributes/POSITION", "12", "accessor 12"},
    {"/nodes/0/mesh", "3", "mesh 3"},
    {"/meshes/0/primitives/0/material", "2", "material 2"},
    {"/scenes/0/nodes", "[5]", "node 5"},
    {"/nodes/0/children", "[7]", "it names node 7, which does not exist"},
    {"/meshes/0/primitives/0/indices", "5", "index 3"},
    {"/meshes/0/primitives/0/indices", "6", "unsigned"},
    {"/meshes/0/primitives/0/attributes/POSITION", "7", "finite"},
    {"/accessors/0/type", R"("SCALAR")", "components"},
    {"/meshes/0/primitives/0/attributes/NORMAL", "3", "has 1 elements, and element 2 is used"},
    {"/meshes/0/primitives/0/attributes/TEXCOORD_1", "4", "has 1 elements, and element 2 is used"},
    {"/materials/0/normalTexture/scale", "1e300",
     "material \"tiles\" has a normal map whose scale is not finite"},
    {"/materials/0/pbrMetallicRoughness/baseColorTexture/extensions",
     R"({"KHR_texture_transform": {"offset": [0, -1e39]}})",
     "material \"tiles\" has a texture transform"},
    {"/materials/0/normalTexture/index", "4", "material \"tiles\" has no texture 4"},
    {"/textures/0/sampler", "3", "material \"tiles\" has a texture without its sampler 3"},
    {"", R"({"asset": {"version": "2.0"}, "nodes": [{}, {"children": [2]}, {"children": [1]}]})",
     "some of its nodes form a cycle"},
    {"", R"({"asset": {"version": "1.0"}, "scene": "s", "nodes": {"n": 1}})",
     "it is glTF 1.0 (asset.version), and version 2.0 is read here"},
    {"/asset/minVersion", R"("2.1")", "it is glTF 2.1 (asset.minVersion)"},
    {"/asset/version", R"("two")", "asset.version is \"two\""},
    {"/meshes/0/primitives/0/mode", "0", "no triangles"},
    {"/accessors/0/type", R"("VEC")",
     "accessors[0].type is \"VEC\"; it must be one of SCALAR, VEC2"},
    {"/materials/0/alphaMode", R"("VEC")", "materials[0].alphaMode is \"VEC\""},
    {"/cameras/0/type", R"("VEC")", "cameras[0].type is \"VEC\""},
    {"/bufferViews/0",
     R"({"buffer": 7, "byteLength": 36, "extensions": {"EXT_meshopt_compression": {"buffer": 0,
         "byteLength": 36, "byteStride": 12, "count": 3, "mode": "ATTRIBUTES"}}})",
     "compressed buffer view 0 is damaged"},
};

TEST(MalformedGltf, FileWithOneFaultIsRefusedInOneSentence) {
  GltfMaker valid = painted({{"index", 0}}, {{"index", 0}, {"texCoord", 1}});
  // The accessors 3 to 7, which a fault may name.
  valid.add<float>("VEC3", {1, 0, 0});
  valid.add<float>("VEC2", {0, 0});
  valid.add<uint16_t>("SCALAR", {0, 1, 3});
  valid.add<float>("SCALAR", {0, 1, 2});
  ASSERT_EQ(valid.add<float>("VEC3", std::vector<float>(9, NAN)), 7);
  for (const auto& [pointer, value, sentence] : kFaults) {
    SCOPED_TRACE(std::string(pointer) + " " + value);
    GltfMaker maker = valid;
    maker.json[nlohmann::json::json_pointer(pointer)] = nlohmann::json::parse(value);
    EXPECT_THAT(refusal(maker.gltf()), HasSubstr(sentence));
    refusal(maker.glb());
  }
}

TEST(GltfCompression, CodecThatIsNotReadIsNamedWithARemedy) {
  GltfMaker maker = GltfMaker::triangle();
  maker.bytes[0] = 0xa1;
  maker.json["bufferViews"][0]["buffer"] = 7;
  maker.json["bufferViews"][0]["extensions"]["KHR_meshopt_compression"] =
      R"({"buffer": 0, "byteLength": 36, "filter": "COLOR", "byteStride": 12, "count": 3,
          "mode": "ATTRIBUTES"})"_json;
  EXPECT_THAT(refusal(maker.gltf()),
              HasSubstr("uses vertex codec 1 of meshoptimizer, which is not read here; pack it by "
                        "gltfpack -ce ext"));
}

// A triangle with one image, given as an embedded PNG whatever the bytes are.
GltfMaker with_image(const std::string& base64) {
  GltfMaker maker = painted({{"index", 0}}, {{"index", 0}});
  maker.json["images"][0] = {{"uri", "data:image/png;base64," + base64}};
  return maker;
}

TEST(GltfFile, EveryTruncationOfABinaryFileIsRefused) {
  const auto glb = GltfMaker::triangle().glb();
  for (size_t size = 0; size < glb.size(); ++size) {
    const std::vector<uint8_t> cut(glb.begin(), glb.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(parse_gltf(cut, "cut.glb", "")) << size;
  }
}

// A file whose triangles show square images of these sizes.
GltfMaker with_images(const std::vector<uint32_t>& sides) {
  GltfMaker maker = painted({{"index", 0}}, {{"index", 0}});
  auto& json = maker.json;
  const nlohmann::json primitive = maker.primitive();
  for (const char* list : {"images", "textures", "materials"}) json[list] = nlohmann::json::array();
  for (size_t i = 0; i < sides.size(); ++i) {
    json["images"].push_back({{"bufferView", maker.view(make_plain_png(sides[i], sides[i], 200))}});
    json["textures"].push_back({{"source", i}});
    json["materials"].push_back({{"emissiveTexture", {{"index", i}}}});
    json["meshes"][0]["primitives"][i] = primitive;
    json["meshes"][0]["primitives"][i]["material"] = i;
  }
  return maker;
}

TEST(GltfImage, LargestImagesAreHalvedUntilAllFitInMemory) {
  GltfLimits limits;
  limits.images.kept = std::uint64_t{3} * 32 * 32;
  const Scene scene = parsed(with_images({128, 16, 64, 16}).gltf(), limits);
  std::vector<uint32_t> sides;
  for (const TextureImage& image : scene.images) sides.push_back(image.width);
  EXPECT_THAT(sides, testing::ElementsAre(32, 16, 32, 16));
  EXPECT_EQ(scene.images[0].rgba[0], 200);
  EXPECT_THAT(scene.warnings, testing::Contains(HasSubstr("2 of 4 are reduced")));
}

TEST(GltfImage, ImagesAfterThoseThatReachTheDecodingLimitAreLeftOut) {
  GltfLimits limits;
  limits.images.decoded = std::uint64_t{2} * 64 * 64;
  const Scene scene = parsed(with_images({64, 64, 64}).gltf(), limits);
  std::vector<int32_t> images;
  for (const Material& material : scene.materials)
    images.push_back(material.emissive_texture.image);
  EXPECT_THAT(images, testing::ElementsAre(0, 1, -1, -1));  // the last is the default
}

TEST(GltfImage, ImagesBeyondTheDecodingLimitAreLeftOutFromTheirHeaders) {
  GltfMaker maker = with_image(GltfMaker::base64(make_png_promise(1024, 1024, 2000)));
  GltfLimits limits;
  limits.images.decoded = 1 << 19;
  const Scene scene = parsed(maker.gltf(), limits);
  EXPECT_TRUE(scene.images.empty());
  EXPECT_THAT(
      scene.warnings,
      testing::ElementsAre(HasSubstr("image 0 (data:...) takes the images of the scene past")));
}

TEST(GltfImage, ImagesThatNoMeshUsesAreNotRead) {
  GltfMaker maker = with_image(GltfMaker::base64(make_png_promise(22'000, 22'000, 500'000)));
  maker.primitive().erase("material");
  const Scene scene = parsed(maker.gltf());
  EXPECT_TRUE(scene.images.empty());
  EXPECT_THAT(scene.warnings, testing::IsEmpty());
}

TEST(GltfImage, DamagedJpegIsLeftOutWithAWarning) {
  auto jpeg = make_jpeg(8, 8, JCS_GRAYSCALE, std::vector<uint8_t>(64, 90));
  // A Huffman table is a marker, a length, a number, and the number of codes by their length in
  // bits. It gets more codes of one bit than there are: a decoder that does not check that writes
  // past the end of its table.
  const uint8_t marker[] = {0xff, 0xc4};
  const auto counts =
      std::search(jpeg.begin(), jpeg.end(), std::begin(marker), std::end(marker)) + 5;
  std::swap(counts[0], counts[2]);
  const Scene scene = parsed(with_image(GltfMaker::base64(jpeg)).gltf());
  EXPECT_THAT(scene.warnings,
              testing::ElementsAre("image 0 (data:...) is damaged and is left out."));
  EXPECT_TRUE(scene.images.empty());
}

TEST(GltfImage, ImagesOtherThanPngAndJpegAreLeftOutWithAWarning) {
  const std::string pgm = "P5 8000 8000 65535\n" + std::string(20'000, '\0');
  const Scene scene = parsed(with_image(GltfMaker::base64(text_bytes(pgm))).gltf());
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_THAT(scene.warnings[0], HasSubstr("image 0 (data:...) is not a PNG or JPEG"));
}

TEST(GltfImage, ImageThatIsTooLargeIsLeftOutFromItsHeader) {
  const auto warning_of = [](const std::vector<uint8_t>& png) {
    const Scene scene = parsed(with_image(GltfMaker::base64(png)).gltf());
    EXPECT_EQ(triangle_count(scene), 1u);
    return scene.warnings.empty() ? "" : scene.warnings[0];
  };
  EXPECT_THAT(warning_of(make_png_promise(22'000, 22'000, 8'000'000)),
              HasSubstr("22000x22000 pixels, more than 16384 a side, and is left out"));
  EXPECT_THAT(warning_of(make_png_promise(16'384, 16'384, 500'000)),
              HasSubstr("256 million pixels, which is more than the 64 million of so small a PNG"));
}

}  // namespace
}  // namespace alcove::sample
