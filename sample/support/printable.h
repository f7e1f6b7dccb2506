#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace alcove::sample {

// Converts text of any bytes, such as a file name, to one line of UTF-8 for JSON and
// terminals: control characters become spaces, and bytes that are not part of a character are
// replaced by U+FFFD.
[[nodiscard]] std::string printable(std::string_view text);

// Returns printable(text), limited to `most` bytes (at least 16). In a longer text, "..." replaces
// the middle, so that a sentence keeps its beginning and its end.
[[nodiscard]] std::string shortened(std::string_view text, std::size_t most);

// Returns the text with the letters A to Z in lower case.
[[nodiscard]] std::string lower_case(std::string_view text);

}  // namespace alcove::sample
