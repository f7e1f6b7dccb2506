// The files that a glTF scene may and may not refer to.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include "gltf_maker.h"
#include "temporary_folder.h"

namespace alcove::sample {
namespace {

using testing::HasSubstr;

std::string error_of(const tl::expected<Scene, std::string>& scene) {
  return scene ? "none" : scene.error();
}

TEST(GltfFile, BinaryFileGivesTheSameSceneAsTheTextFile) {
  const GltfMaker maker = GltfMaker::triangle();
  EXPECT_EQ(corners(parsed(maker.glb())), corners(parsed(maker.gltf())));
}

TEST(GltfFile, FileOutsideTheFolderOfTheSceneIsReportedAsOutsideAndNotAsMissing) {
  const TemporaryFolder folder;
  const std::filesystem::path inside = folder.path / "inside";
  std::filesystem::create_directories(inside);
  GltfMaker maker = painted({{"index", 0}}, {{"index", 0}});
  folder.write("own.bin", std::string("elsewhere"));
  folder.write("t.png", std::string("elsewhere"));
  std::filesystem::create_symlink(folder.path / "own.bin", inside / "link.bin");
  for (const std::string uri : {"../own.bin", "link.bin"}) {
    nlohmann::json json = maker.json;
    json["buffers"] = {{{"byteLength", maker.bytes.size()}, {"uri", uri}}};
    EXPECT_THAT(error_of(load_gltf(folder.write("inside/scene.gltf", json.dump()))),
                HasSubstr("(" + uri + ") lies outside the scene's folder (copy it " + "there as " +
                          uri.substr(uri.find_first_of("ol")) + ")"));
  }
  maker.json["images"][0] = {{"uri", "../t.png"}};
  const auto scene = parse_gltf(maker.gltf(), "test.gltf", inside);
  ASSERT_TRUE(scene) << scene.error();
  EXPECT_THAT(scene->warnings,
              testing::Contains(HasSubstr("image 0 (../t.png) lies outside the scene's folder")));
}

TEST(GltfFile, ErrorForAFileThatCannotBeOpenedGivesTheReasonOfTheSystem) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("loop.gltf", folder.path / "loop.gltf");
  EXPECT_THAT(
      error_of(load_gltf(folder.path / "loop.gltf")),
      testing::EndsWith(std::make_error_code(std::errc::too_many_symbolic_link_levels).message()));
}

TEST(GltfFile, ErrorForAMissingFileNamesTheFile) {
  EXPECT_EQ(error_of(load_gltf("no/such/scene.glb")),
            "cannot read no/such/scene.glb: there is no such file");
  EXPECT_THAT(error_of(load_gltf("https://example.org/a.glb")), HasSubstr("download the file"));
  EXPECT_THAT(error_of(load_gltf("file:///a.glb")), HasSubstr("the path without file://"));
}

TEST(GltfFile, FilesOfOtherKindsAreNamedWithARemedy) {
  const std::pair<std::string, const char*> files[] = {
      {"version https://git-lfs.github.com/spec/v1\noid sha256:0", "git lfs pull"},
      {"\n<!DOCTYPE html><html></html>", "is a web page in place of the file (download"},
      {"<HTML>", "is a web page"},
      {std::string("\xff\xfe{\0", 4), "is UTF-16 text (save it as UTF-8)"},
      {std::string("{\0\"\0", 4), "is UTF-16 text"},
      {"PK\3\4", "is compressed (unpack it first"},
      {"\x89PNG", "is a PNG, JPEG or WebP image (name a .gltf or .glb file)"},
      {"# Read me", "it is not glTF, which begins with { or glTF; name a .gltf"},
      {"{hello", "its JSON cannot be read at byte 2; export it as glTF 2.0 again"},
  };
  for (const auto& [text, sentence] : files)
    EXPECT_THAT(refusal(text_bytes(text)), HasSubstr(sentence));
  const TemporaryFolder folder;
  for (const char* name : {"a.FBX", "a.usda", "a.b.obj"})
    EXPECT_THAT(load_gltf(folder.write(name, std::string("x"))).error(),
                HasSubstr("it is no glTF; convert it to glTF 2.0"));
  EXPECT_THAT(load_gltf(folder.path).error(), HasSubstr("it is a folder; name a file in it"));
  // A repository without its large files has pointers in place of buffers and images.
  GltfMaker maker = painted({{"index", 0}}, {{"index", 0}});
  const std::string pointer = "data:,version%20https://git-lfs.github.com/spec/v1";
  maker.json["images"] = {{{"uri", pointer}}};
  EXPECT_THAT(parsed(maker.gltf()).warnings, testing::Contains(HasSubstr("is a Git LFS pointer")));
  maker.json["buffers"] = {{{"byteLength", maker.bytes.size()}, {"uri", pointer}}};
  EXPECT_THAT(refusal(text_bytes(maker.json.dump())), HasSubstr("is a Git LFS pointer"));
}

TEST(GltfFile, OnlyGltfVersionTwoIsRead) {
  GltfMaker maker = GltfMaker::triangle();
  for (const char* version : {"1.0", "3.0", "20.0"}) {
    maker.json["asset"]["version"] = version;
    EXPECT_THAT(refusal(maker.gltf()), HasSubstr("glTF " + std::string(version)));
    EXPECT_THAT(refusal(maker.glb()), HasSubstr("glTF " + std::string(version)));
  }
  maker.json["asset"]["version"] = 1.0;
  EXPECT_THAT(refusal(maker.gltf()), HasSubstr("glTF 1.0"));
  maker.json["asset"]["version"] = "2.1";
  parsed(maker.gltf());
  std::vector<uint8_t> glb = maker.glb();
  glb[4] = 1;
  EXPECT_THAT(refusal(glb), HasSubstr("binary glTF of version 1"));
}

// A scene whose buffer has that URI, in a folder in which the file has that name.
tl::expected<Scene, std::string> scene_with(const std::string& uri, const std::string& file_name) {
  const TemporaryFolder folder;
  const GltfMaker maker = GltfMaker::triangle();
  nlohmann::json json = maker.json;
  json["buffers"] = {{{"byteLength", maker.bytes.size()}, {"uri", uri}}};
  folder.write(file_name, maker.bytes);
  return load_gltf(folder.write("scene.gltf", json.dump()));
}

// RFC 3986 section 2.1: only %XX is decoded.
TEST(GltfFile, UriIsDecodedAccordingToRfc3986) {
  const std::pair<const char*, const char*> names[] = {
      {"a+b.bin", "a+b.bin"},
      {"c%2Bd.bin", "c+d.bin"},
      {"e%20f.bin", "e f.bin"},
      {"g h.bin", "g h.bin"},
      {"50%2525.bin", "50%25.bin"},
      {"60%.bin", "60%.bin"},
      {"%zz%4.bin", "%zz%4.bin"},
      {"50%25.bin", "50%25.bin"},  // not decoded: the file has the name as it is written
      {"t%C3%B6st.bin", "t\xc3\xb6st.bin"},
      {"r\xc3\xa4um.bin", "r\xc3\xa4um.bin"},
      {"./k.bin", "k.bin"},
      {".\\l.bin", "l.bin"},
      {"m#1?.bin", "m#1?.bin"},
      {"../n.bin", "n.bin"},  // the files beside the scene, or copied there
      {"..\\x\\..\\..\\o.bin", "o.bin"},
  };
  for (const auto& [uri, file_name] : names) {
    const auto scene = scene_with(uri, file_name);
    EXPECT_TRUE(scene) << uri << ": " << scene.error();
  }
  EXPECT_THAT(error_of(scene_with("a b.bin", "a+b.bin")),
              HasSubstr("buffers[0] (a b.bin) is not in the scene's folder"));
}

TEST(GltfFile, UrisThatLeadOutOfTheFolderOfTheSceneAreRefused) {
  for (const char* uri : {"%2e%2e/own.bin", "..\\own.bin", "/etc/passwd", "file:///etc/passwd",
                          "https://example.org/a.bin", "inside/../../own.bin", "a%00.bin"})
    EXPECT_THAT(error_of(scene_with(uri, "other.bin")), HasSubstr("folder")) << uri;
}

TEST(GltfFile, NamedPipesAndFoldersInPlaceOfInputFilesAreRefused) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder.path / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(error_of(load_gltf(folder.path / "pipe")), HasSubstr("not a regular file"));
  nlohmann::json json = GltfMaker::triangle().json;
  for (const char* uri : {"pipe", ".", "/dev/zero"}) {
    json["buffers"] = {{{"byteLength", 36}, {"uri", uri}}};
    EXPECT_FALSE(load_gltf(folder.write("scene.gltf", json.dump()))) << uri;
  }
}

tl::expected<Scene, std::string> scene_with_data(const std::string& uri, size_t length) {
  nlohmann::json json = GltfMaker::triangle().json;
  json["buffers"] = {{{"byteLength", length}, {"uri", uri}}};
  return parse_gltf(text_bytes(json.dump()), "a.gltf", "");
}

TEST(GltfFile, EmbeddedDataUriMayHaveAnyMediaTypeAndBase64OrPercentEncoding) {
  const GltfMaker maker = GltfMaker::triangle();
  const std::string base64 = GltfMaker::base64(maker.bytes);
  std::string percent, spaced = base64;
  for (const uint8_t byte : maker.bytes) {
    constexpr const char* kDigits = "0123456789abcdef";
    percent += std::string("%") + kDigits[byte >> 4] + kDigits[byte & 15];
  }
  spaced.insert(10, "\n ");
  for (const std::string& uri :
       {"data:application/octet-stream;base64," + base64,
        "data:application/gltf-buffer;base64," + base64, "data:;base64," + base64,
        "DATA:text/plain;charset=x;BASE64," + base64, "data:," + percent,
        "data:application/octet-stream," + percent, "data:;base64," + spaced}) {
    const auto scene = scene_with_data(uri, maker.bytes.size());
    EXPECT_TRUE(scene) << uri.substr(0, 40) << ": " << scene.error();
  }
  const std::pair<std::string, const char*> wrong[] = {
      {"data:;base64,!!!!", "is not valid base64"},
      {"data:;base64,AAAAA", "cut short"},
      {"data:;base64", "without data"},
      {"data:;base64,AAAA", "has 3 bytes, and its byteLength says 36"}};
  for (const auto& [uri, sentence] : wrong)
    EXPECT_THAT(error_of(scene_with_data(uri, 36)), HasSubstr(sentence));
}

// glTF 2.0 section 3.6.1: a buffer may have no URI, as a placeholder for an extension.
TEST(GltfFile, BufferWithoutDataIsAllowedUnlessABufferViewUsesIt) {
  GltfMaker maker = GltfMaker::triangle();
  nlohmann::json root = nlohmann::json::parse(maker.gltf());
  root["buffers"].push_back({{"byteLength", 1000}});
  root["buffers"].push_back({{"byteLength", 1000}});
  EXPECT_EQ(corners(parsed(text_bytes(root.dump()))), corners(parsed(maker.gltf())));
  root["bufferViews"][0]["buffer"] = 1;
  EXPECT_THAT(refusal(text_bytes(root.dump())),
              HasSubstr("buffer view 0 lies in buffer 1, which has no data"));
}

// glTF 2.0 section 3.6.2.1: an accessor without a buffer view is zeroes, which sparse values
// replace.
TEST(GltfFile, IndexAccessorWithoutABufferViewIsReadAsZeroesAndSparseValues) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["accessors"].push_back(
      {{"componentType", 5123},
       {"type", "SCALAR"},
       {"count", 3},
       {"sparse",
        {{"count", 2},
         {"indices", {{"bufferView", maker.view<uint8_t>({1, 2})}, {"componentType", 5121}}},
         {"values", {{"bufferView", maker.view<uint16_t>({1, 2})}}}}}});
  const auto expected = corners(parsed(maker.gltf()));
  maker.primitive()["indices"] = 1;
  EXPECT_EQ(corners(parsed(maker.gltf())), expected);
}

// Sets a little-endian word of a file.
void set_word(std::vector<uint8_t>& file, size_t at, uint32_t value) {
  for (size_t i = 0; i < 4; ++i) file[at + i] = static_cast<uint8_t>(value >> 8 * i);
}

TEST(GltfFile, MalformedChunksOfABinaryFileAreRefused) {
  const std::vector<uint8_t> good = GltfMaker::triangle().glb();
  const auto word = [&](size_t at) {
    return uint32_t{good[at]} | uint32_t{good[at + 1]} << 8 | uint32_t{good[at + 2]} << 16;
  };
  const uint32_t json_length = word(12);
  const size_t binary = 20 + json_length;
  struct Case {
    const char* sentence;
    size_t at;
    uint32_t value;
  };
  const Case cases[] = {
      {"its header gives a length of", 8, static_cast<uint32_t>(good.size() + 4)},
      {"its header gives a length of", 8, static_cast<uint32_t>(good.size() - 4)},
      {"its chunk 0 reaches past the end of the file", 12, 0xfffffff0u},
      {"its chunk 0 has a length that is no multiple of 4", 12, json_length + 1},
      {"its chunk 0 is not of the type JSON", 16, 0x004e4942},
      {"its chunk 1 is JSON, as the first one is", binary + 4, 0x4e4f534a},
      {"its chunk 1 reaches past the end of the file", binary, word(binary) + 4},
  };
  for (const Case& c : cases) {
    std::vector<uint8_t> file = good;
    set_word(file, c.at, c.value);
    EXPECT_THAT(refusal(file), HasSubstr(c.sentence));
  }
  std::vector<uint8_t> twice = good;
  twice.insert(twice.end(), good.begin() + static_cast<ptrdiff_t>(binary), good.end());
  set_word(twice, 8, static_cast<uint32_t>(twice.size()));
  EXPECT_THAT(refusal(twice), HasSubstr("its chunk 2 is binary data, which has to be chunk 1"));
}

TEST(GltfFile, UnknownChunksOfABinaryFileAreSkipped) {
  std::vector<uint8_t> file = GltfMaker::triangle().glb();
  const auto expected = corners(parsed(file));
  file.insert(file.end(), {4, 0, 0, 0, 'M', 'I', 'N', 'E', 1, 2, 3, 4});
  set_word(file, 8, static_cast<uint32_t>(file.size()));
  EXPECT_EQ(corners(parsed(file)), expected);
}

}  // namespace
}  // namespace alcove::sample
