#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "support/result.h"

namespace alcove::sample {

// Writes files completely or not at all: each file is written under a temporary name in its folder
// and then renamed. Errors are one sentence with the file's name and the system's reason, such as a
// full disk or a folder without write permission.

// Creates a folder with its parents, before the work whose results it receives.
[[nodiscard]] Result<void> create_folder(const std::filesystem::path& folder);

// Returns the error of writing a file, before the work whose result it receives. Writes nothing.
[[nodiscard]] Result<void> check_writable(const std::filesystem::path& file);

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
