#include "scene/environment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
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

// Returns an uncompressed Radiance file of one colour, given as three mantissas and an exponent.
std::string radiance_file(int width, int height, const std::string& pixel) {
  std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " +
                     std::to_string(width) + "\n";
  for (int i = 0; i < width * height; ++i) text += pixel;
  return text;
}

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

TEST_F(EnvironmentFile, EnvironmentMapsInExrAndRadianceHdrFormatAreRead) {
  EnvironmentImage image(8, 4, glm::vec3(0.5f, 1.0f, 2.0f));
  image.at(3, 1) = {std::numeric_limits<float>::quiet_NaN(), -1.0f,
                    std::numeric_limits<float>::infinity()};
  image.at(5, 1) = glm::vec3(std::numeric_limits<float>::max());
  const auto exr = load(image);
  ASSERT_TRUE(exr) << exr.error();
  EXPECT_EQ(exr->at(0, 0), glm::vec3(0.5f, 1.0f, 2.0f));
  EXPECT_EQ(exr->at(3, 1), glm::vec3(0.0f)) << "negative, infinite and NaN radiance becomes 0";
  EXPECT_EQ(exr->at(5, 1), glm::vec3(65504.0f)) << "the largest 16-bit float";

  const auto hdr = load("b.HDR", radiance_file(8, 4, std::string("\x40\x80\x20\x81", 4)));
  ASSERT_TRUE(hdr) << hdr.error();
  EXPECT_NEAR(hdr->at(5, 2).x, 0.5f, 0.01f);
  EXPECT_NEAR(hdr->at(5, 2).y, 1.0f, 0.01f);
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

// Rows are coded by channel: a run of one value, then single values.
TEST_F(EnvironmentFile, RunLengthEncodedRadianceRowsByChannelAreRead) {
  std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n";
  text += std::string("\x02\x02\x00\x08", 4);
  text += std::string("\x88\x80", 2);                              // red: eight times
  text += std::string("\x08\x10\x20\x30\x40\x50\x60\x70\x80", 9);  // green: each its own
  text += std::string("\x84\x00\x84\x40", 4);                      // blue: two runs
  text += std::string("\x88\x81", 2);                              // exponent: 1 is 128/256 * 2
  const auto image = load("a.hdr", text);
  ASSERT_TRUE(image) << image.error();
  EXPECT_EQ(image->at(0, 0), glm::vec3(1.0f, 0.125f, 0.0f));
  EXPECT_EQ(image->at(7, 0), glm::vec3(1.0f, 1.0f, 0.5f));
}

// In the older coding, the pixel (1, 1, 1, n) repeats the previous pixel n times.
TEST_F(EnvironmentFile, OldStyleRadianceRunsOfWholePixelsAreRead) {
  std::string text = "#?RGBE\n\n-Y 2 +X 300\n";
  const std::string pixel("\x80\x40\x00\x81", 4), other("\x40\x40\x40\x81", 4);
  // 300 is 1 + 42 + 256 + 1: the count's second digit is in units of 256.
  text += pixel + std::string("\x01\x01\x01\x2a\x01\x01\x01\x01", 8) + other;
  for (int i = 0; i < 300; ++i) text += other;
  const auto image = load("a.hdr", text);
  ASSERT_TRUE(image) << image.error();
  EXPECT_EQ(image->at(298, 0), glm::vec3(1.0f, 0.5f, 0.0f));
  EXPECT_EQ(image->at(299, 0), glm::vec3(0.5f));
  EXPECT_EQ(image->at(0, 1), glm::vec3(0.5f));
}

TEST_F(EnvironmentFile, EveryTruncationOfARadianceHdrFileIsRefused) {
  std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 8\n";
  for (int row = 0; row < 2; ++row) {
    text += std::string("\x02\x02\x00\x08", 4);
    for (int channel = 0; channel < 4; ++channel)
      text += std::string("\x84\x80\x04\x01\x02\x03\x04", 7);
  }
  for (size_t size = 0; size <= text.size(); ++size)
    EXPECT_EQ(load("a.hdr", text.substr(0, size)).has_value(), size == text.size()) << size;
}

TEST_F(EnvironmentFile, RadianceRunsPastTheEndOfARowAreRefused) {
  const std::string header = "#?RADIANCE\n\n-Y 1 +X 8\n";
  for (const std::string& row :
       {std::string("\x02\x02\x00\x08\x89\x80", 6), std::string("\x02\x02\x00\x08\x09\x80", 6),
        std::string("\x02\x02\x00\x08\x00\x80", 6), std::string("\x02\x02\x00\x09\x88\x80", 6),
        std::string("\x80\x80\x80\x80\x01\x01\x01\xff", 8), std::string("\x01\x01\x01\x01", 4)}) {
    const auto image = load("a.hdr", header + row + std::string(200, '\x05'));
    ASSERT_FALSE(image);
    EXPECT_THAT(image.error(), HasSubstr("row 0 of 1"));
  }
}

TEST_F(EnvironmentFile, ImagesWithASideOverTheLimitAreRefusedFromTheirHeader) {
  const auto image = load("a.hdr", "#?RADIANCE\n\n-Y 20000 +X 40000\n");
  ASSERT_FALSE(image);
  EXPECT_THAT(image.error(), HasSubstr("40000x20000"));
}

// OpenEXR would allocate as much memory as the attribute's size field says.
TEST_F(EnvironmentFile, ExrFileWithAnAttributeOfWrongSizeIsRefused) {
  const std::string bytes = exr_bytes(EnvironmentImage(8, 4));
  const size_t size = bytes.find(std::string("screenWindowWidth\0float\0", 24)) + 24;
  ASSERT_LT(size, bytes.size());
  for (const auto& [offset, value] : {std::pair<size_t, char>{3, 0x70}, {0, 0}, {0, 8}}) {
    std::string damaged = bytes;
    damaged[size + offset] = value;
    const auto image = load("b.exr", damaged);
    ASSERT_FALSE(image);
    EXPECT_THAT(image.error(), HasSubstr("its attribute screenWindowWidth has a wrong size"));
  }
}

TEST_F(EnvironmentFile, EveryTruncationOfAnExrFileIsRefused) {
  const std::string bytes = exr_bytes(EnvironmentImage(8, 4, glm::vec3(0.5f)));
  for (size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(load("b.exr", bytes.substr(0, size))) << size;
}

TEST_F(EnvironmentFile, InvalidEnvironmentFilesAreRefusedInOneSentence) {
  const std::string good = radiance_file(8, 4, std::string("\x40\x80\x20\x81", 4));
  const std::vector<std::pair<std::string, std::string>> files{
      {"empty.hdr", ""},
      {"text.hdr", "hello"},
      {"header.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n"},
      {"negative.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y -4 +X 8\n"},
      {"promise.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 30000 +X 30000\n\x02\x02"},
      {"empty.exr", ""},
      {"text.exr", "hello"},
      {"magic.exr", std::string("\x76\x2f\x31\x01\x02\x00\x00\x00", 8) + std::string(64, 'a')},
      {"picture.png", good},
      {"noending", good}};
  for (const auto& [name, bytes] : files) {
    const auto loaded = load(name, bytes);
    ASSERT_FALSE(loaded) << name;
    EXPECT_THAT(loaded.error(), HasSubstr(name));
    EXPECT_EQ(loaded.error().find('\n'), std::string::npos) << loaded.error();
  }
  std::filesystem::create_directory(folder_.path / "folder.exr");
  ASSERT_EQ(mkfifo((folder_.path / "pipe.hdr").c_str(), 0600), 0);
  for (const char* name : {"folder.exr", "pipe.hdr"}) {
    const auto loaded = load_environment(folder_.path / name);
    ASSERT_FALSE(loaded) << name;
    EXPECT_THAT(loaded.error(), HasSubstr("not a regular file"));
  }
  const auto missing = load_environment(folder_.path / "missing.hdr");
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error(), HasSubstr("missing.hdr"));
}

}  // namespace
}  // namespace alcove::sample
