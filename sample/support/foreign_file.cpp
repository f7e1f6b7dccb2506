#include "support/foreign_file.h"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace alcove::sample {

std::string foreign_kind(std::span<const uint8_t> bytes, const std::string& remedy) {
  using std::string_view_literals::operator""sv;
  struct Kind {
    std::string_view beginning;  // in lower case
    const char* name;
    const char* remedy = nullptr;
  };
  static constexpr const char* kFetch = "download the file itself";
  static constexpr const char* kUnpack = "unpack it first";
  static constexpr Kind kKinds[] = {
      {"version https://git-lfs"sv, "a Git LFS pointer in place of the file",
       "fetch the file by git lfs pull"},
      {"<!doctype"sv, "a web page in place of the file", kFetch},
      {"<html"sv, "a web page in place of the file", kFetch},
      {"\xff\xfe"sv, "UTF-16 text", "save it as UTF-8"},
      {"\xfe\xff"sv, "UTF-16 text", "save it as UTF-8"},
      {"{\0"sv, "UTF-16 text", "save it as UTF-8"},
      {"\0{"sv, "UTF-16 text", "save it as UTF-8"},
      {"pk\3\4"sv, "a ZIP archive or a .usdz", "unpack it first, and convert USD to glTF 2.0"},
      {"\x1f\x8b"sv, "compressed by gzip", kUnpack},
      {"\x28\xb5\x2f\xfd"sv, "compressed by Zstandard", kUnpack},
      {"kaydara fbx"sv, "Autodesk FBX"},
      {"; fbx"sv, "Autodesk FBX"},
      {"pxr-usdc"sv, "USD"},
      {"#usda"sv, "USD"},
      {"blender"sv, "a Blender file"},
      {"<?xml"sv, "XML, such as COLLADA"},
      {"ply\n"sv, "PLY"},
      {"ply\r"sv, "PLY"},
      {"solid "sv, "STL"},
      {"#?radiance"sv, "Radiance HDR"},
      {"#?rgbe"sv, "Radiance HDR"},
      {"v/1\1"sv, "OpenEXR"},
      {"\x89png"sv, "PNG"},
      {"\xff\xd8\xff"sv, "JPEG"},
      {"riff"sv, "WebP"},
      {"#"sv, "Wavefront OBJ, by its first line"},
      {"mtllib "sv, "Wavefront OBJ"},
      {"v "sv, "Wavefront OBJ"},
      {"o "sv, "Wavefront OBJ"},
      {"g "sv, "Wavefront OBJ"},
  };
  constexpr size_t kLongest = 64;
  std::string start(bytes.begin(), bytes.begin() + std::min(bytes.size(), kLongest));
  if (start.starts_with("\xef\xbb\xbf")) start.erase(0, 3);  // the mark of UTF-8
  const auto lower = [](unsigned char c) { return static_cast<char>(std::tolower(c)); };
  std::ranges::transform(start, start.begin(), lower);
  start.erase(0, start.find_first_not_of(" \t\r\n"));
  for (const Kind& kind : kKinds)
    if (start.starts_with(kind.beginning))
      return std::string("is ").append(kind.name) + " (" + (kind.remedy ? kind.remedy : remedy) +
             ")";
  return "";
}

std::string missing_file(const std::filesystem::path& file) {
  const std::string name = file.string();
  if (name.starts_with("file:")) return "it is an address; give the path without file://";
  if (name.find("://") != std::string::npos || name.starts_with("http:") ||
      name.starts_with("https:"))
    return "it is an address; download the file and give its path";
  return "there is no such file";
}

}  // namespace alcove::sample
