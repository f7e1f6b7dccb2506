// Formats numbers for the sentences of the library.
#pragma once

#include <array>
#include <charconv>
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

[[nodiscard]] inline std::string size_text(VkExtent2D size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

}  // namespace alcove::passes
