#include "support/printable.h"

#include <nlohmann/json.hpp>

namespace alcove::sample {
namespace {

// Returns whether a byte is not the first one of a UTF-8 character.
bool continues(char byte) { return (static_cast<unsigned char>(byte) & 0xc0u) == 0x80; }

}  // namespace

std::string printable(std::string_view text) {
  using nlohmann::json;
  const std::string valid = json(text).dump(-1, ' ', false, json::error_handler_t::replace);
  auto out = json::parse(valid).get<std::string>();
  std::ranges::replace_if(
      out, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, ' ');
  return out;
}

std::string shortened(std::string_view text, std::size_t most) {
  constexpr std::string_view kDots = "...";
  std::string out = printable(text);
  if (out.size() <= most) return out;
  // Two thirds of the length are for the beginning. No character is cut in two.
  std::size_t head = (most - kDots.size()) * 2 / 3;
  std::size_t tail = out.size() - (most - kDots.size() - head);
  while (head > 0 && continues(out[head])) --head;
  while (tail < out.size() && continues(out[tail])) ++tail;
  return out.substr(0, head).append(kDots).append(out, tail, std::string::npos);
}

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

}  // namespace alcove::sample
