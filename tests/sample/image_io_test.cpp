#include "support/image_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <limits>

#include "temporary_folder.h"

namespace alcove::sample {
namespace {

size_t files_in(const std::filesystem::path& folder) {
  size_t count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++count;
  return count;
}

TEST(ImageIo, GreyExrComesBackBitForBit) {
  const TemporaryFolder folder;
  Image<float> image(7, 3);
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = 0.1f * static_cast<float>(i) - 0.3f;
  }
  image.at(6, 2) = std::numeric_limits<float>::infinity();
  ASSERT_TRUE(write_exr(folder.path / "a.exr", image));
  const auto read = read_exr_grey(folder.path / "a.exr");
  ASSERT_TRUE(read) << read.error();
  EXPECT_EQ(read->width, 7u);
  EXPECT_EQ(read->pixels, image.pixels);
  EXPECT_EQ(files_in(folder.path), 1u);
}

TEST(ImageIo, ColourExrKeepsChannelsAndRows) {
  const TemporaryFolder folder;
  Image<glm::vec3> image(2, 2);
  image.at(0, 0) = {1, 2, 3};
  image.at(1, 1) = {-4, 5, 6};
  ASSERT_TRUE(write_exr(folder.path / "a.exr", image));
  const auto read = read_exr_rgb(folder.path / "a.exr");
  ASSERT_TRUE(read) << read.error();
  EXPECT_EQ(read->pixels, image.pixels);
}

TEST(ImageIo, FolderThatIsNotThereIsNamed) {
  const auto written = write_png("no/such/folder/a.png", Image<float>(2, 2));
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error(), testing::HasSubstr("no/such/folder/a.png"));
}

TEST(ImageIo, FullDiskIsReportedAndNothingIsLeft) {
  if (!std::filesystem::exists("/dev/full")) return;  // not Linux
  const TemporaryFolder folder;
  const auto written = write_whole(folder.path / "a", [](const std::filesystem::path&) {
    std::ofstream full("/dev/full");
    full << "x" << std::flush;
    return full ? tl::expected<void, std::string>()
                : tl::unexpected<std::string>("No space left on device");
  });
  EXPECT_FALSE(written);
  EXPECT_EQ(files_in(folder.path), 0u);
}

TEST(ImageIo, WhatAnInterruptedWriteLeftGoesWithTheNextOfItsFile) {
  const TemporaryFolder folder;
  const auto left = [&](const char* name, bool long_ago) {
    std::ofstream(folder.path / name) << "half";
    if (long_ago) {
      std::filesystem::last_write_time(
          folder.path / name,
          std::filesystem::file_time_type::clock::now() - std::chrono::hours(2));
    }
  };
  left("a.png.part123", true);
  left("a.png.part4", false);   // another process may be writing it
  left("a.png.partner", true);  // somebody's own
  left("b.a.png.part5", true);  // of another file
  ASSERT_TRUE(write_png(folder.path / "a.png", Image<float>(2, 2)));
  EXPECT_FALSE(std::filesystem::exists(folder.path / "a.png.part123"));
  EXPECT_EQ(files_in(folder.path), 4u);
}

TEST(ImageIo, AFolderThatNothingCanBeWrittenToIsRefused) {
  if (!std::filesystem::exists("/proc/self")) return;  // not Linux
  const auto made = create_folder("/proc/self");
  ASSERT_FALSE(made);
  EXPECT_THAT(made.error(), testing::HasSubstr("/proc/self"));
  const TemporaryFolder folder;
  EXPECT_TRUE(create_folder(folder.path / "a" / "b"));
  EXPECT_EQ(files_in(folder.path / "a" / "b"), 0u);
}

TEST(ImageIo, ImageWithoutPixelsIsRefused) {
  EXPECT_FALSE(write_exr("a.exr", Image<float>()));
  EXPECT_FALSE(write_png("a.png", Image<glm::vec3>()));
}

TEST(ImageIo, DamagedExrIsRefused) {
  const TemporaryFolder folder;
  std::ofstream(folder.path / "a.exr") << "this is not an image";
  const auto read = read_exr_grey(folder.path / "a.exr");
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error(), testing::HasSubstr("a.exr"));
}

}  // namespace
}  // namespace alcove::sample
