#include "reference/truth_cache.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <functional>

#include "scene/builtin_scene.h"
#include "temporary_folder.h"

namespace alcove::sample {
namespace {

CacheKey key_of(int number) {
  CacheKey key;
  key.add(number);
  return key;
}

std::filesystem::path only_file(const std::filesystem::path& folder) {
  return std::filesystem::directory_iterator(folder)->path();
}

TEST(TruthCache, CachedTruthIsReadOnlyUnderItsOwnKeyAndSize) {
  const TemporaryFolder folder;
  const TruthCache cache(folder.path / "deep" / "cache");
  Image<glm::vec3> image(3, 2, glm::vec3(1, 2, 3));
  cache.write(key_of(1), image);
  Image<glm::vec3> read(3, 2);
  EXPECT_TRUE(cache.read(key_of(1), read));
  EXPECT_EQ(read.pixels, image.pixels);
  EXPECT_FALSE(cache.read(key_of(2), read));
  EXPECT_FALSE(cache.read(key_of(1), 17));
}

TEST(TruthCache, DamagedCacheEntriesAndThoseOfEarlierVersionsAreTreatedAsAbsent) {
  const TemporaryFolder folder;
  const TruthCache cache(folder.path);
  const std::vector<float> values(100, 0.5f);
  cache.write(key_of(1), values);
  const auto file = only_file(folder.path);
  const auto size = std::filesystem::file_size(file);
  for (const size_t at :
       {size_t{0}, size_t{9}, size_t{20}, size_t{40}, static_cast<size_t>(size - 1)}) {
    cache.write(key_of(1), values);
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(static_cast<std::streamoff>(at));
    stream.put('\x7f');
    stream.close();
    EXPECT_FALSE(cache.read(key_of(1), values.size())) << at;
  }
  cache.write(key_of(1), values);
  std::filesystem::resize_file(file, size - 4);
  EXPECT_FALSE(cache.read(key_of(1), values.size()));
  cache.write(key_of(1), values);
  std::fstream(file, std::ios::in | std::ios::out | std::ios::binary) << "alcovet1";
  EXPECT_FALSE(cache.read(key_of(1), values.size()));
}

TEST(TruthCache, CacheKeyDependsOnTheOrderAndBoundariesOfItsParts) {
  const auto key_of_texts = [](const std::vector<std::string>& texts) {
    CacheKey key;
    for (const std::string& text : texts) key.add(text);
    return key.hex();
  };
  EXPECT_EQ(key_of_texts({"ab", "c"}), key_of_texts({"ab", "c"}));
  EXPECT_NE(key_of_texts({"ab", "c"}), key_of_texts({"a", "bc"}));
  EXPECT_NE(key_of_texts({"ab", "c"}), key_of_texts({"c", "ab"}));
  EXPECT_NE(key_of_texts({"ab", "c"}), key_of_texts({"ab", "c", ""}));
}

TEST(TruthCache, NamedPipeInPlaceOfACacheEntryIsTreatedAsAbsentAndReplaced) {
  const TemporaryFolder folder;
  const TruthCache cache(folder.path);
  const std::vector<float> values(100, 0.5f);
  ASSERT_EQ(mkfifo((folder.path / (key_of(1).hex() + ".truth")).c_str(), 0600), 0);
  EXPECT_FALSE(cache.read(key_of(1), values.size()));
  cache.write(key_of(1), values);
  EXPECT_TRUE(cache.read(key_of(1), values.size()));
}

TEST(TruthCache, WritingACacheEntryLeavesNoTemporaryFiles) {
  const TemporaryFolder folder;
  const TruthCache cache(folder.path);
  for (int i = 0; i < 3; ++i) cache.write(key_of(1), std::vector<float>(5, 1.0f));
  EXPECT_EQ(folder.files(), 1);
}

TEST(TruthCache, CacheKeyChangesWithSceneAndCamera) {
  const std::function<void(Scene&)> changes[] = {
      [](Scene& s) { s.meshes[0].positions[0].x += 1e-3f; },
      [](Scene& s) { s.materials[0].base_color.g *= 0.5f; },
      [](Scene& s) { s.materials[0].base_color_texture.uv_set = 1; },
      [](Scene& s) { s.materials[0].base_color_texture.sampler.magnify = Filter::nearest; }};
  CacheKey key, turned;
  key.add(builtin_scene());
  for (const auto& change : changes) {
    Scene scene = builtin_scene();
    change(scene);
    CacheKey changed;
    changed.add(scene);
    EXPECT_NE(changed.hex(), key.hex()) << &change - changes;
  }
  turned.add(builtin_scene(), builtin_scene().cameras[0]);
  EXPECT_NE(turned.hex(), key.hex());
}

TEST(TruthCache, NothingIsCachedIfNoCacheFolderIsGiven) {
  const TruthCache cache("");
  cache.write(key_of(1), std::vector<float>(5, 1.0f));
  EXPECT_FALSE(cache.read(key_of(1), 5));
}

}  // namespace
}  // namespace alcove::sample
