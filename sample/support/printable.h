#pragma once

#include <string>
#include <string_view>

namespace alcove::sample {

// `text` as one line of UTF-8, which JSON and SVG must be and names of files need not: a space for
// each control character, U+FFFD for each byte that is no part of a character.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace alcove::sample
