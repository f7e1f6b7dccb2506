#include "support/foreign_file.h"

#include <algorithm>
#include <string_view>
#include <system_error>
#include <vector>

#include "support/printable.h"

namespace alcove::sample {

std::string foreign_kind(std::span<const uint8_t> bytes, const std::string& remedy) {
  using std::string_view_literals::operator""sv;
  struct Kind {
    const char* name;
    const char* remedy;                   // null for the caller's
    std::vector<std::string_view> begin;  // in lower case
  };
  static const Kind kKinds[] = {
      {"a Git LFS pointer in place of the file",
       "fetch the file by git lfs pull",
       {"version https://git-lfs"sv}},
      {"a web page in place of the file", "download the file itself", {"<!doctype"sv, "<html"sv}},
      {"UTF-16 text", "save it as UTF-8", {"\xff\xfe"sv, "\xfe\xff"sv, "{\0"sv, "\0{"sv}},
      {"compressed", "unpack it first", {"pk\3\4"sv, "\x1f\x8b"sv, "\x28\xb5\x2f\xfd"sv}},
      {"an OpenEXR image", nullptr, {"v/1\1"sv}},
      {"a Radiance HDR image", nullptr, {"#?radiance"sv, "#?rgbe"sv}},
      {"a PNG, JPEG or WebP image", nullptr, {"\x89png"sv, "\xff\xd8\xff"sv, "riff"sv}},
  };
  constexpr size_t kLongest = 64;
  std::string start(bytes.begin(), bytes.begin() + std::min(bytes.size(), kLongest));
  if (start.starts_with("\xef\xbb\xbf")) start.erase(0, 3);  // the mark of UTF-8
  start = lower_case(start);
  start.erase(0, start.find_first_not_of(" \t\r\n"));
  for (const auto& [name, own_remedy, beginnings] : kKinds) {
    if (std::ranges::any_of(beginnings, [&](auto begin) { return start.starts_with(begin); }))
      return std::string("is ") + name + " (" + (own_remedy ? own_remedy : remedy) + ")";
  }
  return "";
}

bool has_other_format(const std::filesystem::path& file) {
  static constexpr std::string_view kExtensions[] = {
      ".3ds", ".abc", ".blend", ".dae", ".fbx", ".ma",  ".max",  ".mb",   ".obj",
      ".ply", ".skp", ".step",  ".stl", ".stp", ".usd", ".usda", ".usdc", ".usdz"};
  return std::ranges::find(kExtensions, lower_case(file.extension().string())) !=
         std::end(kExtensions);
}

std::string missing_file(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) return "it is a folder; name a file in it";
  if (std::filesystem::exists(file, ignored)) return "it is not a regular file";
  if (name.starts_with("file:")) return "it is an address; give the path without file://";
  if (name.find("://") != std::string::npos || name.starts_with("http:") ||
      name.starts_with("https:"))
    return "it is an address; download the file and give its path";
  return "there is no such file";
}

}  // namespace alcove::sample
