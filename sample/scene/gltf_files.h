#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace alcove::sample {

// The only way in which a glTF file reaches other files: regular files in the scene's folder or
// below it, after symbolic links are followed, up to a number of bytes in all; and data that is
// embedded in the URI itself.
class GltfFiles {
 public:
  // An empty folder: no files at all.
  explicit GltfFiles(const std::filesystem::path& folder);

  // The bytes that a URI names. A relative reference is decoded after RFC 3986: %XX stands for a
  // byte, and no other character for anything but itself. Where no file has that name, the name as
  // it is written is tried, and then the name with \ for /, as exporters on Windows write it.
  // `data:` URIs may have any media type, and be base64 or percent-encoded. Errors are the end of a
  // sentence that begins with the URI.
  [[nodiscard]] tl::expected<std::vector<uint8_t>, std::string> read(const std::string& uri);

  // The URI as a sentence can hold it: embedded data is left out.
  [[nodiscard]] static std::string shown(const std::string& uri);

 private:
  tl::expected<std::vector<uint8_t>, std::string> read_file(const std::filesystem::path& file);

  std::filesystem::path folder_;  // canonical
  uint64_t bytes_left_;
};

// All of a regular file of at most `most` bytes. Errors are the end of a sentence.
[[nodiscard]] tl::expected<std::vector<uint8_t>, std::string> read_regular_file(
    const std::filesystem::path& file, uint64_t most);

// The largest file, and the most bytes of all files of a scene together.
constexpr uint64_t kMostFileBytes = INT32_MAX;

}  // namespace alcove::sample
