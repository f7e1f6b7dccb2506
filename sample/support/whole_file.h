#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace alcove::sample {

// Files appear completely or not at all: each is written under a temporary name in its folder and
// then renamed. Errors are one sentence with the file's name and the system's reason, such as a
// full disk or a folder without write permission.

// A folder for output, made with those above it, before the work that fills it. Unless anything was
// written to it, the destructor removes what it has made, so that a run that is refused leaves
// nothing behind.
class OutputFolder {
 public:
  // An error also where the folder exists and no file can be made in it.
  [[nodiscard]] static tl::expected<OutputFolder, std::string> create(
      const std::filesystem::path& folder);
  OutputFolder(OutputFolder&&) = default;
  OutputFolder& operator=(OutputFolder&&) = delete;
  ~OutputFolder();

 private:
  OutputFolder() = default;
  std::vector<std::filesystem::path> made_;  // the outermost first
};

// `write` fills the temporary file whose name it gets, and says whether that worked.
[[nodiscard]] tl::expected<void, std::string> write_whole(
    const std::filesystem::path& file,
    const std::function<tl::expected<void, std::string>(const std::filesystem::path&)>& write);
[[nodiscard]] tl::expected<void, std::string> write_bytes(const std::filesystem::path& file,
                                                          const void* bytes, size_t size);
[[nodiscard]] tl::expected<void, std::string> write_text(const std::filesystem::path& file,
                                                         const std::string& text);

// Removes the temporary files in a folder whose writers were killed. A writer holds a lock on its
// file (flock), which ends with the process; where the file system has no locks, a file counts as
// abandoned when it is an hour old. `write_whole` does this for the file that it writes.
void remove_abandoned(const std::filesystem::path& folder);

}  // namespace alcove::sample
