#include "support/printable.h"

#include <cstddef>
#include <cstdint>

namespace alcove::sample {
namespace {

uint8_t byte_at(std::string_view text, size_t i) {
  return i < text.size() ? static_cast<uint8_t>(text[i]) : 0;
}

bool continues(std::string_view text, size_t i) { return (byte_at(text, i) & 0xc0u) == 0x80; }

// Returns the length in bytes of the UTF-8 character at the beginning of `text`, after table 3-7 of
// the Unicode standard, or 0 if there is no valid character.
size_t character_size(std::string_view text) {
  const uint8_t first = byte_at(text, 0), second = byte_at(text, 1);
  if (first < 0x80) return 1;
  if (first < 0xc2 || first > 0xf4 || !continues(text, 1)) return 0;
  if (first < 0xe0) return 2;
  // Overlong encodings, halves of a surrogate pair and values above U+10FFFF are not valid.
  if ((first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f) ||
      (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f) || !continues(text, 2))
    return 0;
  if (first < 0xf0) return 3;
  return continues(text, 3) ? 4 : 0;
}

bool is_control(char c) { return static_cast<uint8_t>(c) < 0x20 || c == 0x7f; }

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const size_t size = character_size(text);
    if (size == 0)
      out += "\xef\xbf\xbd";
    else if (is_control(text.front()))
      out += ' ';
    else
      out += text.substr(0, size);
    text.remove_prefix(size == 0 ? 1 : size);
  }
  return out;
}

std::string shortened(std::string_view text, std::size_t most) {
  constexpr std::string_view kDots = "...";
  std::string out = printable(text);
  if (out.size() <= most) return out;
  // Two thirds of the length are for the beginning. No character is cut in two.
  std::size_t head = (most - kDots.size()) * 2 / 3;
  std::size_t tail = out.size() - (most - kDots.size() - head);
  while (head > 0 && continues(out, head)) --head;
  while (tail < out.size() && continues(out, tail)) ++tail;
  return out.substr(0, head).append(kDots).append(out, tail, std::string::npos);
}

}  // namespace alcove::sample
