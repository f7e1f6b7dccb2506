// Reads the offsets of struct members from a SPIR-V module.
#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace alcove::maths_test {

struct StructLayout {
  std::string name;                              // of the struct in GLSL
  std::map<std::string, std::uint32_t> offsets;  // in bytes, for each member
};

namespace detail {

inline std::string literal_string(std::span<const std::uint32_t> words) {
  std::string bytes(words.size() * 4, '\0');
  std::memcpy(bytes.data(), words.data(), bytes.size());
  return bytes.substr(0, bytes.find('\0'));
}

}  // namespace detail

// Returns every struct of the module that has member offsets. A struct with two memory layouts has
// two entries.
inline std::vector<StructLayout> struct_layouts(std::span<const std::uint32_t> module) {
  constexpr std::uint32_t kOpName = 5, kOpMemberName = 6, kOpMemberDecorate = 72, kOffset = 35;
  std::map<std::uint32_t, std::string> names;
  std::map<std::uint32_t, std::map<std::uint32_t, std::string>> members;
  std::map<std::uint32_t, std::map<std::uint32_t, std::uint32_t>> offsets;
  for (std::size_t at = 5; at < module.size();) {
    const std::uint32_t length = module[at] >> 16, code = module[at] & 0xffffu;
    if (length == 0 || at + length > module.size()) break;
    const auto words = module.subspan(at, length);
    if (code == kOpName) names[words[1]] = detail::literal_string(words.subspan(2));
    if (code == kOpMemberName)
      members[words[1]][words[2]] = detail::literal_string(words.subspan(3));
    if (code == kOpMemberDecorate && words[3] == kOffset) offsets[words[1]][words[2]] = words[4];
    at += length;
  }
  std::vector<StructLayout> layouts;
  for (const auto& [type, by_index] : offsets) {
    StructLayout layout{names[type], {}};
    for (const auto& [index, offset] : by_index) layout.offsets[members[type][index]] = offset;
    layouts.push_back(layout);
  }
  return layouts;
}

}  // namespace alcove::maths_test
