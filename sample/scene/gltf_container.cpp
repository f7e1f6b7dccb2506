#include "scene/gltf_container.h"

#include <cstring>

namespace alcove::sample {
namespace {

using Bytes = std::span<const uint8_t>;

constexpr uint32_t kMagic = 0x46546c67;   // "glTF"
constexpr uint32_t kJson = 0x4e4f534a;    // "JSON"
constexpr uint32_t kBinary = 0x004e4942;  // "BIN"
constexpr size_t kHeader = 12;            // bytes: magic, version, length
constexpr size_t kChunkHeader = 8;        // bytes: length, type

// Reads a 32-bit word. All numbers in glTF are little-endian.
uint32_t word(Bytes bytes, size_t at) {
  return uint32_t{bytes[at]} | uint32_t{bytes[at + 1]} << 8 | uint32_t{bytes[at + 2]} << 16 |
         uint32_t{bytes[at + 3]} << 24;
}

Result<void> check_header(Bytes file) {
  if (file.size() < kHeader) return Failure("its header is cut short");
  if (const uint32_t version = word(file, 4); version != 2) {
    return Failure("it is binary glTF of version " + std::to_string(version) +
                   ", and only version 2 is read; export it as glTF 2.0");
  }
  if (const uint32_t length = word(file, 8); length != file.size()) {
    return Failure("its header gives a length of " + std::to_string(length) +
                   " bytes, and it has " + std::to_string(file.size()) +
                   "; it was cut short or damaged, so copy or export it again");
  }
  return {};
}

}  // namespace

Result<GltfParts> split_gltf(Bytes file) {
  if (file.size() < 4 || word(file, 0) != kMagic) return GltfParts{file, {}, false};
  ALCOVE_TRY_VOID(check_header(file));
  GltfParts parts;
  size_t index = 0;
  for (size_t at = kHeader; at < file.size(); ++index) {
    const auto refuse = [&](const std::string& why) {
      return Failure("its chunk " + std::to_string(index) + " " + why + "; export it again");
    };
    if (file.size() - at < kChunkHeader) return refuse("has a header that is cut short");
    const uint32_t length = word(file, at), type = word(file, at + 4);
    at += kChunkHeader;
    if (length > file.size() - at) return refuse("reaches past the end of the file");
    if (length % 4 != 0) return refuse("has a length that is no multiple of 4");
    if ((index == 0) != (type == kJson))
      return refuse(index == 0 ? "is not of the type JSON" : "is JSON, as the first one is");
    if (type == kBinary && index != 1) return refuse("is binary data, which has to be chunk 1");
    if (type == kJson) parts.json = file.subspan(at, length);
    if (type == kBinary) parts.binary = file.subspan(at, length);
    parts.has_binary |= type == kBinary;
    at += length;
  }
  if (index == 0) return Failure("it has no JSON; export it again");
  return parts;
}

}  // namespace alcove::sample
