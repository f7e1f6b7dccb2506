#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace alcove::sample {

// Returns what a file is that was given in place of another, by its first bytes, and what to do:
// the end of a sentence that begins with its name, such as "is an OpenEXR image (REMEDY)". Files
// that have to be fetched or unpacked have remedies of their own. Empty if the bytes are of no
// known kind.
[[nodiscard]] std::string foreign_kind(std::span<const uint8_t> bytes, const std::string& remedy);

// Returns whether the extension is that of another 3D format than glTF.
[[nodiscard]] bool has_other_format(const std::filesystem::path& file);

// Returns the reason why there is no regular file of this name, which may be that of a folder or an
// address.
[[nodiscard]] std::string missing_file(const std::filesystem::path& file);

}  // namespace alcove::sample
