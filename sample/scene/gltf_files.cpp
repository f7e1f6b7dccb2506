#include "scene/gltf_files.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <string_view>
#include <system_error>

#include "support/printable.h"
#include "support/regular_file.h"

namespace alcove::sample {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<uint8_t>;

int hexadecimal(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// Decodes %XX (RFC 3986 section 2.1). A % that is not followed by two hexadecimal digits is kept.
std::string percent_decoded(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (size_t i = 0; i < text.size(); ++i) {
    const int high = i + 2 < text.size() && text[i] == '%' ? hexadecimal(text[i + 1]) : -1;
    const int low = high < 0 ? -1 : hexadecimal(text[i + 2]);
    if (low < 0) {
      out.push_back(text[i]);
    } else {
      out.push_back(static_cast<char>(high << 4 | low));
      i += 2;
    }
  }
  return out;
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

// Decodes base64 (RFC 4648 section 4). White space is skipped, and the padding may be missing.
Result<Bytes> base64_decoded(std::string_view text) {
  Bytes out;
  out.reserve(text.size() / 4 * 3 + 2);
  uint32_t group = 0;
  int bits = 0;
  size_t padding = 0;
  for (const char c : text) {
    if (std::isspace(static_cast<unsigned char>(c)) != 0) continue;
    const int digit = base64_digit(c);
    if (c == '=' && padding < 2) {
      ++padding;
      continue;
    }
    if (digit < 0 || padding > 0) return Failure("is not valid base64");
    group = group << 6 | static_cast<uint32_t>(digit);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    out.push_back(static_cast<uint8_t>(group >> bits));
  }
  if (bits == 6) return Failure("is base64 that is cut short");
  return out;
}

constexpr std::string_view kData = "data:";

bool is_data(const std::string& uri) {
  return lower_case(std::string_view(uri).substr(0, kData.size())) == kData;
}

// Returns the bytes of a data URI (RFC 2397): data:[media type][;base64],data
Result<Bytes> read_data_uri(const std::string& uri) {
  const size_t comma = uri.find(',');
  if (comma == std::string::npos) return Failure("is a data URI without data");
  const std::string header = lower_case(std::string_view(uri).substr(0, comma));
  const std::string_view data = std::string_view(uri).substr(comma + 1);
  // Base64 data usually has no percent-encoding, so that the decoding of %XX is skipped if there is
  // no %.
  if (header.ends_with(";base64")) {
    return data.find('%') == std::string_view::npos ? base64_decoded(data)
                                                    : base64_decoded(percent_decoded(data));
  }
  const std::string decoded = percent_decoded(data);
  return Bytes(decoded.begin(), decoded.end());
}

// Returns whether a URI has a scheme (RFC 3986 section 3.1). A single letter is a Windows drive and
// not a scheme.
bool has_scheme(const std::string& uri) {
  const size_t colon = uri.find(':');
  if (colon == std::string::npos || colon < 2 ||
      std::isalpha(static_cast<unsigned char>(uri[0])) == 0)
    return false;
  return std::all_of(uri.begin(), uri.begin() + static_cast<ptrdiff_t>(colon), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '+' || c == '-' || c == '.';
  });
}

bool lies_within(const fs::path& file, const fs::path& folder) {
  const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return end == folder.end() && rest != file.end();
}

// Returns the path without the root and the leading .. that lead out of a folder.
std::string without_way_out(const fs::path& path) {
  fs::path out;
  for (const fs::path& name : path.lexically_normal().relative_path())
    if (name != "..") out /= name;
  return out.string();
}

}  // namespace

Result<Bytes> read_regular_file(const fs::path& file, uint64_t most) {
  ALCOVE_TRY(const auto opened, open_regular_file(file));
  std::FILE* stream = opened.get();
  const long end = std::fseek(stream, 0, SEEK_END) == 0 ? std::ftell(stream) : -1;
  if (end < 0 || std::fseek(stream, 0, SEEK_SET) != 0) return Failure("cannot be read");
  const auto size = static_cast<uint64_t>(end);
  if (size > most) {
    return Failure("has " + std::to_string(size) + " bytes, and at most " + std::to_string(most) +
                   " more are read for a scene");
  }
  Bytes out(size);
  if (std::fread(out.data(), 1, size, stream) != size) return Failure("cannot be read to its end");
  return out;
}

GltfFiles::GltfFiles(const fs::path& folder) : bytes_left_(kMostFileBytes) {
  std::error_code ignored;
  if (!folder.empty()) folder_ = fs::canonical(folder, ignored);
}

Result<Bytes> GltfFiles::read(const std::string& uri) {
  if (is_data(uri)) return read_data_uri(uri);
  if (has_scheme(uri)) return Failure("is no file in the scene's folder");
  if (folder_.empty()) return Failure("cannot be read: the scene is not in a folder");
  const std::string decoded = percent_decoded(uri);
  std::string slashes = decoded;
  std::ranges::replace(slashes, '\\', '/');
  const std::string below = without_way_out(slashes);
  bool outside = false;
  for (const std::string& name : {decoded, uri, slashes, below}) {
    if (name.find('\0') != std::string::npos) continue;
    std::error_code error;
    const fs::path file = fs::canonical(folder_ / name, error);
    if (error) continue;
    if (lies_within(file, folder_)) return read_file(file);
    outside = true;
  }
  if (!outside) return Failure("is not in the scene's folder");
  return Failure("lies outside the scene's folder (copy it there as " + shown(below) + ")");
}

Result<Bytes> GltfFiles::read_file(const fs::path& file) {
  auto bytes = read_regular_file(file, bytes_left_);
  if (bytes) bytes_left_ -= bytes->size();
  return bytes;
}

std::string GltfFiles::shown(const std::string& uri) {
  constexpr size_t kLongest = 80;  // bytes
  if (is_data(uri)) return std::string(kData) + "...";
  return uri.size() <= kLongest ? uri : uri.substr(0, kLongest) + "...";
}

}  // namespace alcove::sample
