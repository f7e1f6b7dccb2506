// Which files a glTF scene is read from, and which not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include "gltf_maker.h"
#include "temporary_folder.h"

namespace alcove::sample {
namespace {

using testing::HasSubstr;

TEST(GltfFile, BinaryFileReadsAsItsTextTwin) {
  const GltfMaker maker = GltfMaker::triangle();
  EXPECT_EQ(corners(parsed(maker.glb())), corners(parsed(maker.gltf())));
}

TEST(GltfFile, ExternalBufferIsReadFromTheFolderAndNowhereElse) {
  const TemporaryFolder folder;
  GltfMaker maker = GltfMaker::triangle();
  std::filesystem::create_directories(folder.path / "inside");
  const auto write = [](const std::filesystem::path& file, const auto& bytes) {
    std::ofstream(file, std::ios::binary) << std::string(bytes.begin(), bytes.end());
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

TEST(GltfFile, AFileThatIsThereAndMayNotBeReadIsNotCalledMissing) {
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

TEST(GltfFile, WhatKeepsAFileFromBeingOpenedIsSaid) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("loop.gltf", folder.path / "loop.gltf");
  const auto scene = load_gltf(folder.path / "loop.gltf");
  ASSERT_FALSE(scene);
  EXPECT_THAT(
      scene.error(),
      testing::EndsWith(std::make_error_code(std::errc::too_many_symbolic_link_levels).message()));
}

TEST(GltfFile, MissingFileIsNamed) {
  const auto scene = load_gltf("no/such/scene.glb");
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error(), "cannot read no/such/scene.glb: there is no such file");
}

TEST(GltfFile, OnlyTheSecondVersionIsRead) {
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

}  // namespace
}  // namespace alcove::sample
