// Textures of glTF files: their transforms, sets of coordinates and samplers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "gltf_maker.h"

namespace alcove::sample {
namespace {

TEST(GltfTexture, TextureTransformScalesThenRotatesCounterClockwiseThenTranslates) {
  // The example of the extension's specification: the lower left quarter of the image, rotated.
  const nlohmann::json quarter = {
      {"offset", {0, 1}}, {"rotation", 1.57079632679}, {"scale", {0.5, 0.5}}};
  const nlohmann::json uneven = {{"offset", {3, 5}}, {"rotation", 0.5}, {"scale", {2, -4}}};
  GltfMaker maker = textured(transformed(quarter), transformed(uneven));
  maker.json["extensionsRequired"] = {"KHR_texture_transform"};
  const Scene scene = parsed(maker.gltf());
  ASSERT_EQ(scene.materials.size(), 2u);
  const TextureUse& base = scene.materials[0].base_color_texture;
  EXPECT_LT(glm::distance(texture_uv(base, {glm::vec2(0, 0)}), glm::vec2(0, 1)), 1e-6f);
  EXPECT_LT(glm::distance(texture_uv(base, {glm::vec2(1, 0)}), glm::vec2(0, 0.5)), 1e-6f);
  EXPECT_LT(glm::distance(texture_uv(base, {glm::vec2(0, 1)}), glm::vec2(0.5, 1)), 1e-6f);
  const TextureUse& normal = scene.materials[0].normal_texture;
  const float c = std::cos(0.5f), s = std::sin(0.5f);
  EXPECT_LT(glm::distance(texture_uv(normal, {glm::vec2(1, 0)}), glm::vec2(3 + 2 * c, 5 - 2 * s)),
            1e-5f);
  EXPECT_LT(glm::distance(texture_uv(normal, {glm::vec2(0, 1)}), glm::vec2(3 - 4 * s, 5 - 4 * c)),
            1e-5f);
}

TEST(GltfTexture, TextureUsesTheUvSetNamedByItsReferenceOrItsTransform) {
  nlohmann::json overridden = transformed({{"texCoord", 1}});
  overridden["texCoord"] = 0;
  for (const nlohmann::json& second : {nlohmann::json{{"index", 0}, {"texCoord", 1}}, overridden}) {
    const Scene scene = parsed(painted({{"index", 0}}, second).gltf());
    ASSERT_EQ(scene.meshes.size(), 1u);
    const Mesh& mesh = scene.meshes[0];
    EXPECT_THAT(mesh.uvs, testing::ElementsAre(glm::vec2(0), glm::vec2(3, 0), glm::vec2(0, 3)));
    EXPECT_THAT(mesh.second_uvs,
                testing::ElementsAre(glm::vec2(0), glm::vec2(7, 0), glm::vec2(0, 7)));
    const Material& material = scene.materials[mesh.material];
    EXPECT_EQ(texture_uv(material.base_color_texture, uvs_at(mesh, 1)), glm::vec2(3, 0));
    EXPECT_EQ(texture_uv(material.normal_texture, uvs_at(mesh, 1)), glm::vec2(7, 0));
    EXPECT_THAT(scene.warnings, testing::IsEmpty());
  }
}

TEST(GltfTexture, SecondUvSetThatNoTextureUsesIsDropped) {
  const Scene scene = parsed(painted({{"index", 0}}, {{"index", 0}}).gltf());
  EXPECT_TRUE(scene.meshes[0].second_uvs.empty());
}

TEST(GltfTexture, MissingUvSetIsReportedAndReadAsZero) {
  for (const std::string set : {"0", "1"}) {
    GltfMaker maker = painted({{"index", 0}}, {{"index", 0}, {"texCoord", 1}});
    maker.primitive()["attributes"].erase("TEXCOORD_" + set);
    const Scene scene = parsed(maker.gltf());
    EXPECT_THAT(scene.warnings, testing::ElementsAre("Mesh 0 lacks the texture coordinates " + set +
                                                     " that its material names: they are taken "
                                                     "to be zero."));
    const glm::vec2 read = uvs_at(scene.meshes[0], 1)[set == "0" ? 0 : 1];
    EXPECT_EQ(read, glm::vec2(0));
  }
}

TEST(GltfTexture, SamplersAreReadAndMissingFiltersDefaultToLinear) {
  GltfMaker maker = painted({{"index", 0}}, {{"index", 1}});
  maker.white_texture();
  maker.json["samplers"] = {
      {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}, {"minFilter", 9985}},
      nlohmann::json::object()};
  maker.json["textures"][0]["sampler"] = 0;
  maker.json["textures"][1]["sampler"] = 1;
  const Material material = parsed(maker.gltf()).materials[0];
  EXPECT_EQ(
      material.base_color_texture.sampler,
      (Sampler{Wrap::clamp, Wrap::mirror, Filter::nearest, Filter::linear, MipFilter::nearest}));
  EXPECT_EQ(material.normal_texture.sampler, Sampler{});
  const std::pair<int, Sampler> filters[] = {
      {9728, {.minify = Filter::nearest, .mips = MipFilter::none}},
      {9729, {.mips = MipFilter::none}},
      {9984, {.minify = Filter::nearest, .mips = MipFilter::nearest}},
      {9986, {.minify = Filter::nearest}},
      {9987, {}}};
  for (const auto& [filter, sampler] : filters) {
    maker.json["samplers"][1]["minFilter"] = filter;
    EXPECT_EQ(parsed(maker.gltf()).materials[0].normal_texture.sampler, sampler) << filter;
  }
}

TEST(GltfTexture, SamplersWithWrapModesOrFiltersUnknownToGltfAreLeftOut) {
  const std::pair<nlohmann::json, std::string> samplers[] = {
      {{{"wrapS", 33070}}, "sampler 0 has a wrap mode unknown to glTF and is left out."},
      {{{"wrapT", 0}}, "sampler 0 has a wrap mode unknown to glTF and is left out."},
      {{{"magFilter", 9987}}, "sampler 0 has a filter unknown to glTF and is left out."},
      {{{"minFilter", 7}}, "sampler 0 has a filter unknown to glTF and is left out."}};
  for (const auto& [sampler, warning] : samplers) {
    GltfMaker maker = painted({{"index", 0}}, {{"index", 0}});
    maker.json["samplers"] = {sampler};
    maker.json["textures"][0]["sampler"] = 0;
    const Scene scene = parsed(maker.gltf());
    EXPECT_THAT(scene.warnings, testing::ElementsAre(warning));
    EXPECT_EQ(scene.materials[0].base_color_texture.sampler, Sampler{});
  }
}

}  // namespace
}  // namespace alcove::sample
