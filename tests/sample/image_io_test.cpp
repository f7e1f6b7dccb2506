#include "support/image_io.h"

#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>
#include <limits>
#include <vector>

#include "support/decode_image.h"
#include "temporary_folder.h"

namespace alcove::sample {
namespace {

// The values of channels of an OpenEXR file, interleaved.
std::vector<float> read_exr(const std::filesystem::path& file,
                            const std::vector<const char*>& channels, uint32_t width,
                            uint32_t height) {
  std::vector<float> values(channels.size() * width * height);
  Imf::FrameBuffer frame;
  const size_t pixel = channels.size() * sizeof(float);
  for (size_t c = 0; c < channels.size(); ++c) {
    frame.insert(channels[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data() + c),
                                         pixel, pixel * width));
  }
  Imf::InputFile input(file.string().c_str());
  input.setFrameBuffer(frame);
  input.readPixels(0, static_cast<int>(height) - 1);
  return values;
}

TEST(ImageIo, GreyExrImageIsReadBackExactly) {
  const TemporaryFolder folder;
  Image<float> image(7, 3);
  for (size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = 0.1f * static_cast<float>(i) - 0.3f;
  image.at(6, 2) = std::numeric_limits<float>::infinity();
  ASSERT_TRUE(write_exr(folder.path / "a.exr", image));
  EXPECT_EQ(read_exr(folder.path / "a.exr", {"Y"}, 7, 3), image.pixels);
  EXPECT_EQ(folder.files(), 1);
}

TEST(ImageIo, ColourExrIsReadBackWithChannelsAndRowsInOrder) {
  const TemporaryFolder folder;
  Image<glm::vec3> image(2, 2);
  image.at(0, 0) = {1, 2, 3};
  image.at(1, 1) = {-4, 5, 6};
  ASSERT_TRUE(write_exr(folder.path / "a.exr", image));
  EXPECT_THAT(read_exr(folder.path / "a.exr", {"R", "G", "B"}, 2, 2),
              testing::ElementsAre(1, 2, 3, 0, 0, 0, 0, 0, 0, -4, 5, 6));
}

TEST(ImageIo, ErrorForAMissingOutputFolderNamesTheFile) {
  const auto written = write_png("no/such/folder/a.png", Image<float>(2, 2));
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error(), testing::HasSubstr("no/such/folder/a.png"));
}

TEST(ImageIo, WritingAnImageWithoutPixelsIsRefused) {
  EXPECT_FALSE(write_exr("a.exr", Image<float>()));
  EXPECT_FALSE(write_png("a.png", Image<glm::vec3>()));
}

TEST(ImageIo, NamedPipeInPlaceOfAnOutputFileIsReplacedByTheFile) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder.path / "a.png").c_str(), 0600), 0);
  ASSERT_TRUE(write_png(folder.path / "a.png", Image<float>(2, 2)));
  EXPECT_TRUE(std::filesystem::is_regular_file(folder.path / "a.png"));
}

TEST(ImageIo, FolderInPlaceOfAnOutputFileIsAnErrorThatNamesTheFile) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path / "a.png");
  const auto written = write_png(folder.path / "a.png", Image<float>(2, 2));
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error(), testing::HasSubstr("a.png"));
  EXPECT_EQ(folder.files(), 1);
}

TEST(ImageIo, PngIsWrittenAsEightBitsAndReadBack) {
  const TemporaryFolder folder;
  Image<glm::vec3> image(2, 1);
  image.at(0, 0) = {0.0f, 0.5f, 2.0f};
  image.at(1, 0) = {std::numeric_limits<float>::quiet_NaN(), 1.0f, -1.0f};
  ASSERT_TRUE(write_png(folder.path / "a.png", image));
  std::ifstream file(folder.path / "a.png", std::ios::binary);
  const std::vector<uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
  const auto header = read_image_header(bytes);
  ASSERT_TRUE(header) << header.error();
  const auto read = decode_image(bytes, *header);
  ASSERT_TRUE(read) << read.error();
  EXPECT_THAT(read->rgba, testing::ElementsAre(0, 128, 255, 255, 0, 255, 0, 255));
}

}  // namespace
}  // namespace alcove::sample
