#include "support/whole_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>

#include "temporary_folder.h"

namespace alcove::sample {
namespace {

TEST(WholeFile, FullDiskIsReportedAndNoPartialFileIsLeft) {
  if (!std::filesystem::exists("/dev/full")) return;  // not Linux
  const TemporaryFolder folder;
  const auto written = write_whole(folder.path / "a", [](const std::filesystem::path&) {
    std::ofstream full("/dev/full");
    full << "x" << std::flush;
    return full ? tl::expected<void, std::string>()
                : tl::unexpected<std::string>("No space left on device");
  });
  EXPECT_FALSE(written);
  EXPECT_EQ(folder.files(), 0);
}

TEST(WholeFile, TemporaryFilesOfAnHourAgoAreRemovedAndNoOthers) {
  const TemporaryFolder folder;
  for (const char* name : {"a.txt.part123", "b.txt.part5", "c.txt"})
    std::ofstream(folder.path / name) << "half";
  const auto old = std::filesystem::file_time_type::clock::now() - std::chrono::hours(2);
  std::filesystem::last_write_time(folder.path / "a.txt.part123", old);
  std::filesystem::last_write_time(folder.path / "c.txt", old);
  remove_abandoned(folder.path);
  EXPECT_FALSE(std::filesystem::exists(folder.path / "a.txt.part123"));
  EXPECT_EQ(folder.files(), 2);
}

TEST(WholeFile, FileInPlaceOfAFolderIsRefusedAndAFolderInPlaceOfAFile) {
  const TemporaryFolder folder;
  EXPECT_THAT(write_text(folder.path, "text").error(), testing::HasSubstr("it is a folder"));
  std::ofstream(folder.path / "a") << "a file";
  for (const char* name : {"a", "a/b"}) {
    const auto made = create_folder(folder.path / name);
    ASSERT_FALSE(made);
    EXPECT_THAT(made.error(), testing::HasSubstr("could not be created"));
  }
}

}  // namespace
}  // namespace alcove::sample
