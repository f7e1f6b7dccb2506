#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>

#include "support/result.h"

namespace alcove::sample {

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using FilePointer = std::unique_ptr<std::FILE, FileCloser>;

// Opens a regular file for reading. Other files are refused, because opening a named pipe or a
// device could wait forever. The error completes a sentence that begins with the file's name.
[[nodiscard]] Result<FilePointer> open_regular_file(const std::filesystem::path& file);

}  // namespace alcove::sample
