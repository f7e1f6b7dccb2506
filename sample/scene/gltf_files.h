#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "support/result.h"

namespace alcove::sample {

// Reads the files that a glTF file names: regular files in the scene's folder or below it, after
// symbolic links are resolved, and data that is embedded in a URI. All files together may have at
// most kMostFileBytes.
class GltfFiles {
 public:
  // If `folder` is empty, no file can be read.
  explicit GltfFiles(const std::filesystem::path& folder);

  // Returns the bytes that a URI names. A relative reference is decoded after RFC 3986: %XX is a
  // byte, and all other characters are themselves. If no such file exists, the name is tried
  // without decoding, then with every \ replaced by /, because exporters on Windows write \, and
  // then without a beginning that leads out of the folder, such as ../.
  // `data:` URIs may have any media type, and be base64 or percent-encoded. Error texts are the end
  // of a sentence that begins with the URI.
  [[nodiscard]] Result<std::vector<uint8_t>> read(const std::string& uri);

  // Returns the URI for a message, without embedded data and shortened to 80 bytes.
  [[nodiscard]] static std::string shown(const std::string& uri);

 private:
  Result<std::vector<uint8_t>> read_file(const std::filesystem::path& file);

  std::filesystem::path folder_;  // canonical
  uint64_t bytes_left_;
};

// Reads a whole regular file. A file of more than `most` bytes is an error. Error texts are the end
// of a sentence whose beginning the caller adds.
[[nodiscard]] Result<std::vector<uint8_t>> read_regular_file(const std::filesystem::path& file,
                                                             uint64_t most);

// The limit on the size of a file, and on the sum of the sizes of all files of a scene.
constexpr uint64_t kMostFileBytes = INT32_MAX;

}  // namespace alcove::sample
