#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "support/result.h"

namespace alcove::sample {

// Writes files completely or not at all: each file is written under a temporary name in its folder
// and then renamed. Errors are one sentence with the file's name and the system's reason, such as a
// full disk or a folder without write permission.

// An output folder that is created, with its parents, before the work whose results it receives.
// The destructor removes the folders that it created and that are still empty, so that a failed run
// leaves nothing behind.
class OutputFolder {
 public:
  // Returns an error also if the folder exists and no file can be created in it.
  [[nodiscard]] static Result<OutputFolder> create(const std::filesystem::path& folder);
  OutputFolder(OutputFolder&&) = default;
  OutputFolder& operator=(OutputFolder&&) = delete;
  ~OutputFolder();

 private:
  OutputFolder() = default;
  std::vector<std::filesystem::path> made_;  // the outermost first
};

// `write` fills the temporary file of the given name, and returns whether it succeeded.
[[nodiscard]] Result<void> write_whole(
    const std::filesystem::path& file,
    const std::function<Result<void>(const std::filesystem::path&)>& write);
[[nodiscard]] Result<void> write_bytes(const std::filesystem::path& file, const void* bytes,
                                       size_t size);
[[nodiscard]] Result<void> write_text(const std::filesystem::path& file, const std::string& text);

// Removes the temporary files in a folder that have not been written for an hour, because their
// writers were killed.
void remove_abandoned(const std::filesystem::path& folder);

}  // namespace alcove::sample
