#include "scene/environment.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
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
  std::string note;
  ASSERT_TRUE(
      load_environment(folder_.path / "a.exr", [&](const std::string& text) { note = text; }));
  EXPECT_THAT(note, HasSubstr("clipped"));
}

// Writes an image of ones in channels of these names, with these windows.
void write_windows(const std::filesystem::path& file, const Imath::Box2i& display,
                   const Imath::Box2i& data, const std::vector<const char*>& names,
                   Imf::Envmap kind = Imf::ENVMAP_LATLONG) {
  Imf::Header header(display, data);
  Imf::addEnvmap(header, kind);
  const int width = data.max.x - data.min.x + 1, height = data.max.y - data.min.y + 1;
  const std::vector<float> ones(static_cast<size_t>(width) * static_cast<size_t>(height), 1.0f);
  Imf::FrameBuffer frame;
  for (const char* name : names) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    frame.insert(name, Imf::Slice::Make(Imf::FLOAT, ones.data(), data));
  }
  Imf::OutputFile output(file.string().c_str(), header);
  output.setFrameBuffer(frame);
  output.writePixels(height);
}

TEST_F(EnvironmentFile, DataWindowIsPlacedInTheDisplayWindow) {
  const std::filesystem::path file = folder_.path / "window.exr";
  const auto image_of = [&](const Imath::Box2i& data) {
    write_windows(file, {{0, 0}, {7, 3}}, data, {"R", "G", "B"});
    return load_environment(file);
  };
  for (const Imath::Box2i& data : {Imath::Box2i{{2, 1}, {5, 2}}, {{2, -7}, {90, 2}}}) {
    const auto image = image_of(data);
    ASSERT_TRUE(image) << image.error();
    ASSERT_EQ(image->width, 8u);
    ASSERT_EQ(image->height, 4u);
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 8; ++x)
        EXPECT_EQ(image->at(uint32_t(x), uint32_t(y)).x,
                  data.intersects(Imath::V2i(x, y)) ? 1.0f : 0.0f);
  }
  EXPECT_THAT(image_of({{20, 0}, {30, 3}}).error(), HasSubstr("no pixels in its display window"));
}

TEST_F(EnvironmentFile, RefusalNamesARemedy) {
  write_windows(folder_.path / "z.exr", {{0, 0}, {7, 3}}, {{0, 0}, {7, 3}}, {"G", "Z"});
  EXPECT_THAT(load_environment(folder_.path / "z.exr").error(),
              HasSubstr("no channels R, G and B, but G, Z; save it with these three"));
  EXPECT_THAT(load("a.hdr", "#?RADIANCE\n").error(),
              HasSubstr("a Radiance HDR image (convert it to OpenEXR)"));
  EXPECT_THAT(load("a.exr", "version https://git-lfs").error(), HasSubstr("git lfs pull"));
  EXPECT_THAT(load_environment("https://example.org/a.exr").error(),
              HasSubstr("download the file"));
  EXPECT_THAT(load_environment(folder_.path).error(), HasSubstr("it is a folder"));
  write_windows(folder_.path / "cube.exr", {{0, 0}, {7, 3}}, {{0, 0}, {7, 3}}, {"R", "G", "B"},
                Imf::ENVMAP_CUBE);
  EXPECT_THAT(load_environment(folder_.path / "cube.exr").error(), HasSubstr("is a cube map"));
  // A light probe, and cube maps as a strip, a column and crosses.
  for (const auto& [width, height] :
       {std::pair(8u, 8u), {48u, 8u}, {8u, 48u}, {32u, 24u}, {24u, 32u}})
    EXPECT_THAT(load(EnvironmentImage(width, height)).error(), HasSubstr("twice as wide as high"));
  EXPECT_TRUE(load(EnvironmentImage(401, 200)));
}

TEST_F(EnvironmentFile, LargeEnvironmentMapsAreReducedByAveragingPixels) {
  EnvironmentImage image(2052, 1026);
  for (uint32_t y = 0; y < 1026; ++y)
    for (uint32_t x = 0; x < 2052; ++x) image.at(x, y) = glm::vec3(x % 2 ? 3.0f : 1.0f);
  const auto loaded = load(image);
  ASSERT_TRUE(loaded) << loaded.error();
  EXPECT_EQ(loaded->width, 1026u);
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
