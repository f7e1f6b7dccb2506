// Numbers in what the library says.
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace alcove::passes {

// The shortest text that reads back as the same float, at most 15 characters. Unlike
// std::to_string it is the same in every locale that the program may have set.
[[nodiscard]] inline std::string number_text(float value) {
  std::array<char, 16> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

}  // namespace alcove::passes
