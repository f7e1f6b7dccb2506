#include "support/whole_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

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

TEST(WholeFile, AbandonedTemporaryFilesAreRemovedByTheNextWriteOfTheFile) {
  const TemporaryFolder folder;
  for (const char* name : {"a.txt.part123", "a.txt.partner", "b.a.txt.part5"}) {
    std::ofstream(folder.path / name) << "half";
  }
  ASSERT_TRUE(write_text(folder.path / "a.txt", "whole"));
  EXPECT_FALSE(std::filesystem::exists(folder.path / "a.txt.part123"));
  EXPECT_EQ(folder.files(),
            3u);  // a file of another kind and one of another target are kept
  remove_abandoned(folder.path);
  EXPECT_FALSE(std::filesystem::exists(folder.path / "b.a.txt.part5"));
  EXPECT_EQ(folder.files(), 2);
}

// The writer is a separate process that is killed while it writes.
TEST(WholeFile, TemporaryFileOfAStillRunningWriterIsNotRemoved) {
  const TemporaryFolder folder;
  int pipe_ends[2];
  ASSERT_EQ(pipe(pipe_ends), 0);
  const pid_t writer = fork();
  ASSERT_GE(writer, 0);
  if (writer == 0) {
    (void)write_whole(folder.path / "a", [&](const std::filesystem::path& temporary) {
      std::ofstream(temporary) << "half" << std::flush;
      (void)!write(pipe_ends[1], "x", 1);
      for (;;) pause();
      return tl::expected<void, std::string>();
    });
    _exit(1);
  }
  char byte = 0;
  ASSERT_EQ(read(pipe_ends[0], &byte, 1), 1);
  remove_abandoned(folder.path);
  EXPECT_EQ(folder.files(), 1);
  kill(writer, SIGKILL);
  waitpid(writer, nullptr, 0);
  remove_abandoned(folder.path);
  EXPECT_EQ(folder.files(), 0);
  close(pipe_ends[0]);
  close(pipe_ends[1]);
}

TEST(OutputFolder, OutputFolderWithoutWritePermissionIsRefused) {
  if (!std::filesystem::exists("/proc/self")) return;  // not Linux
  const auto made = OutputFolder::create("/proc/self");
  ASSERT_FALSE(made);
  EXPECT_THAT(made.error(), testing::HasSubstr("/proc/self"));
}

TEST(OutputFolder, FileInPlaceOfTheOutputFolderIsRefused) {
  const TemporaryFolder folder;
  std::ofstream(folder.path / "a") << "a file";
  for (const char* name : {"a", "a/b"}) {
    const auto made = OutputFolder::create(folder.path / name);
    ASSERT_FALSE(made);
    EXPECT_THAT(made.error(), testing::HasSubstr("could not be created"));
  }
}

TEST(OutputFolder, OutputFoldersThatWereCreatedAndStayedEmptyAreRemoved) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path / "old");
  {
    const auto made = OutputFolder::create(folder.path / "old" / "new" / "deep");
    ASSERT_TRUE(made) << made.error();
    EXPECT_TRUE(std::filesystem::is_empty(folder.path / "old" / "new" / "deep"));
  }
  EXPECT_TRUE(std::filesystem::exists(folder.path / "old"));
  EXPECT_FALSE(std::filesystem::exists(folder.path / "old" / "new"));
}

TEST(OutputFolder, OutputFoldersWithFilesAndThoseThatExistedBeforeAreKept) {
  const TemporaryFolder folder;
  {
    const auto made = OutputFolder::create(folder.path / "new" / "deep");
    ASSERT_TRUE(write_text(folder.path / "new" / "deep" / "a", "text"));
    const auto existing = OutputFolder::create(folder.path);
    ASSERT_TRUE(existing);
  }
  EXPECT_TRUE(std::filesystem::exists(folder.path / "new" / "deep" / "a"));
}

}  // namespace
}  // namespace alcove::sample
