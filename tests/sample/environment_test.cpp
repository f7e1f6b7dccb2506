#include "scene/environment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <limits>
#include <string>

#include "support/image_io.h"
#include "temporary_folder.h"

namespace alcove::sample {
namespace {

using testing::HasSubstr;

class EnvironmentFile : public testing::Test {
 protected:
  tl::expected<EnvironmentImage, std::string> load(const std::string& name,
                                                   const std::string& bytes) {
    return load_environment(folder_.write(name, bytes));
  }
  tl::expected<EnvironmentImage, std::string> load(const EnvironmentImage& exr) {
    EXPECT_TRUE(write_exr(folder_.path / "a.exr", exr));
    return load_environment(folder_.path / "a.exr");
  }
  std::string exr_bytes(const EnvironmentImage& exr) {
    EXPECT_TRUE(write_exr(folder_.path / "a.exr", exr));
    std::ifstream in(folder_.path / "a.exr", std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  TemporaryFolder folder_;
};

TEST(Environment, BuiltInSkyHasMeanRadianceAboutOneAndIsBrighterThanTheGround) {
  const auto sky = load_environment({});
  ASSERT_TRUE(sky);
  const glm::vec3 mean = mean_radiance(*sky);
  EXPECT_NEAR((mean.x + mean.y + mean.z) / 3.0f, 1.0f, 0.25f);
  EXPECT_GT(radiance(*sky, {0, 1, 0}).z, radiance(*sky, {0, -1, 0}).z);
}

TEST(Environment, DirectionPlusXIsAtAQuarterOfTheImageWidthAndColumnsWrapAround) {
  EnvironmentImage image(64, 32);
  image.at(16, 16) = glm::vec3(5);  // a quarter to the right: +X, just under the horizon
  const glm::vec3 there = glm::normalize(glm::vec3(1.0f, -0.05f, 0.05f));
  EXPECT_GT(radiance(image, there).x, 4.0f);
  EXPECT_EQ(radiance(image, {-1, 0, 0}).x, 0.0f);
  // Columns wrap around.
  image.at(63, 16) = glm::vec3(5);
  const glm::vec3 seam = glm::normalize(glm::vec3(0.0f, -0.05f, -1.0f));
  EXPECT_NEAR(radiance(image, seam).x, 2.5f, 0.3f);
}

TEST_F(EnvironmentFile, EnvironmentMapsInExrFormatAreRead) {
  EnvironmentImage image(8, 4, glm::vec3(0.5f, 1.0f, 2.0f));
  image.at(3, 1) = {std::numeric_limits<float>::quiet_NaN(), -1.0f,
                    std::numeric_limits<float>::infinity()};
  image.at(5, 1) = glm::vec3(std::numeric_limits<float>::max());
  const auto exr = load(image);
  ASSERT_TRUE(exr) << exr.error();
  EXPECT_EQ(exr->at(0, 0), glm::vec3(0.5f, 1.0f, 2.0f));
  EXPECT_EQ(exr->at(3, 1), glm::vec3(0.0f, 0.0f, 65504.0f)) << "NaN and negative radiance is 0";
  EXPECT_EQ(exr->at(5, 1), glm::vec3(65504.0f)) << "the largest 16-bit float";
}

TEST_F(EnvironmentFile, LargeEnvironmentMapsAreReducedByAveragingPixels) {
  EnvironmentImage image(4096, 4);
  for (uint32_t y = 0; y < 4; ++y)
    for (uint32_t x = 0; x < 4096; ++x) image.at(x, y) = glm::vec3(x % 2 ? 3.0f : 1.0f);
  const auto loaded = load(image);
  ASSERT_TRUE(loaded) << loaded.error();
  EXPECT_EQ(loaded->width, 2048u);
  for (const glm::vec3& pixel : loaded->pixels) ASSERT_EQ(pixel, glm::vec3(2.0f));
}

TEST_F(EnvironmentFile, EveryTruncationOfAnExrFileIsRefused) {
  const std::string bytes = exr_bytes(EnvironmentImage(8, 4, glm::vec3(0.5f)));
  for (size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(load("b.exr", bytes.substr(0, size))) << size;
}

TEST_F(EnvironmentFile, InvalidEnvironmentFilesAreRefusedInOneSentence) {
  const std::vector<std::pair<std::string, std::string>> files{
      {"empty.exr", ""},
      {"text.exr", "hello"},
      {"magic.exr", std::string("\x76\x2f\x31\x01\x02\x00\x00\x00", 8) + std::string(64, 'a')},
      {"picture.png", "hello"}};
  for (const auto& [name, bytes] : files) {
    const auto loaded = load(name, bytes);
    ASSERT_FALSE(loaded) << name;
    EXPECT_THAT(loaded.error(), HasSubstr(name));
    EXPECT_EQ(loaded.error().find('\n'), std::string::npos) << loaded.error();
  }
  const auto missing = load_environment(folder_.path / "missing.exr");
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error(), HasSubstr("missing.exr"));
}

}  // namespace
}  // namespace alcove::sample
