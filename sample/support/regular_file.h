#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <tl/expected.hpp>

namespace alcove::sample {

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using FilePointer = std::unique_ptr<std::FILE, FileCloser>;

// Opens a regular file for reading. Opening a named pipe or a device could wait for ever, so
// anything but a regular file is refused, and the check is made on the opened file: nobody can swap
// it in between. The error is the end of a sentence that begins with the file's name.
[[nodiscard]] tl::expected<FilePointer, std::string> open_regular_file(
    const std::filesystem::path& file);

}  // namespace alcove::sample
