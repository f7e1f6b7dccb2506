#pragma once

#include <fmt/format.h>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "support/glm.h"

namespace alcove::sample {

// Returns the number that the whole text is, or nothing.
template <typename Number>
std::optional<Number> parse_number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole ? std::optional(value) : std::nullopt;
}

// A mistake in the command line, described by a sentence. It is thrown within parse_options() only,
// as CLI11's own errors are.
struct Mistake {
  std::string text;
};

// An option and the text of its value. Each conversion throws a Mistake for a value that it does
// not accept; `wanted` completes the sentence "give ...".
struct OptionValue {
  std::string option;
  std::string text;

  [[noreturn]] void refuse(const std::string& wanted) const;

  // Returns a number within [low, high].
  double number(double low, double high, const std::string& wanted) const;
  std::int64_t whole_number(std::int64_t low, std::int64_t high, const std::string& wanted) const;
  float length() const;       // finite and above 0, in scene units
  glm::dvec3 vector() const;  // finite as floats too
  // Returns the texts between commas as values of the option.
  std::vector<OptionValue> parts() const;
  // Returns the numbers between commas: from `fewest` to `most`, each within [low, high].
  std::vector<double> numbers(std::size_t fewest, std::size_t most, double low, double high,
                              const std::string& wanted) const;
  // Returns the numbers of WIDTHxHEIGHT, each from 1 to 16384.
  std::pair<std::uint32_t, std::uint32_t> size() const;
  // Returns the index of the value in a list of names.
  std::size_t one_of(std::span<const std::string_view> names) const;
  // Returns the enumerator of the value, whose names are in order, or nothing for the name `all`.
  template <class Choice>
  std::optional<Choice> one_of_or(std::span<const std::string_view> names,
                                  std::string_view all) const {
    std::vector<std::string_view> allowed(names.begin(), names.end());
    allowed.push_back(all);
    const std::size_t which = one_of(allowed);
    return which < names.size() ? std::optional(static_cast<Choice>(which)) : std::nullopt;
  }
};

// Returns the shortest text that is parsed as the same number.
template <typename Number>
[[nodiscard]] std::string number_text(Number value) {
  return fmt::to_string(value);
}

// Returns the shortest text of a coordinate from which the same float is parsed. The text is in the
// space of the scene's file, which is `value` plus `origin`.
[[nodiscard]] std::string coordinate_text(float value, double origin);

}  // namespace alcove::sample
