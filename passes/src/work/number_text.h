// Numbers for the sentences of the library.
#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <string>

#include <vulkan/vulkan_core.h>

namespace alcove::passes {

// Returns the shortest text that reads back as the same float, at most 15 characters. Unlike
// std::to_string, it does not depend on the locale of the program.
[[nodiscard]] inline std::string number_text(float value) {
  std::array<char, 16> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

// Returns the bits of an enum that C code wrote. Reading a value that the enum does not have would
// be undefined behaviour in C++.
template <typename Enum>
[[nodiscard]] std::uint32_t number_of(const Enum& value) {
  std::uint32_t number = 0;
  static_assert(sizeof value == sizeof number);
  std::memcpy(&number, &value, sizeof number);
  return number;
}

[[nodiscard]] inline std::string size_text(VkExtent2D size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

}  // namespace alcove::passes
