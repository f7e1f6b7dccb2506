#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace alcove::sample {

// `text` as one line of UTF-8, which JSON, SVG and terminals need and file names need not be: a
// space for each control character, U+FFFD for each byte that is not part of a character.
[[nodiscard]] std::string printable(std::string_view text);

// printable(text) of at most `most` bytes, at least 16: where it is longer, "..." stands for its
// middle, so that a sentence keeps its beginning and its end.
[[nodiscard]] std::string shortened(std::string_view text, std::size_t most);

}  // namespace alcove::sample
