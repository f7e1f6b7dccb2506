// Converts the text of an option's value. Each function returns a reader: a function from the text
// to the value, whose error completes the sentence "give ...".
#pragma once

#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "support/glm.h"
#include "support/result.h"

namespace alcove::sample {

// Returns the number that the whole text is, or nothing.
template <typename Number>
std::optional<Number> parse_number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole ? std::optional(value) : std::nullopt;
}

// A number from `low` to `high`.
template <typename Number>
auto number(Number low, Number high, const std::string& wanted) {
  return [=](std::string_view text) -> Result<Number> {
    const auto value = parse_number<Number>(text);
    if (!value || !(*value >= low && *value <= high)) return Failure(wanted);
    return *value;
  };
}

// A number above 0.
template <typename Number>
auto positive(const std::string& wanted) {
  return number(std::numeric_limits<Number>::denorm_min(), std::numeric_limits<Number>::max(),
                wanted);
}

// An angle in degrees, as radians.
inline auto degrees(float low, float high, const std::string& wanted) {
  return [read = number(low, high, wanted)](std::string_view text) {
    return read(text).transform([](float angle) { return glm::radians(angle); });
  };
}

// A text that is not empty.
inline auto text(const std::string& wanted) {
  return [=](std::string_view value) -> Result<std::string> {
    if (value.empty()) return Failure(wanted);
    return std::string(value);
  };
}

// The index of a name.
template <typename Choice = std::size_t>
auto one_of(std::span<const std::string_view> names) {
  return [=](std::string_view value) -> Result<Choice> {
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i] == value) return static_cast<Choice>(i);
    return Failure(fmt::format("one of {}", fmt::join(names, ", ")));
  };
}

// The enumerator of a name, or nothing for the name `all`.
template <typename Choice>
auto one_of_or(std::span<const std::string_view> names, std::string_view all) {
  std::vector<std::string_view> allowed(names.begin(), names.end());
  allowed.push_back(all);
  return [=](std::string_view value) -> Result<std::optional<Choice>> {
    return one_of(allowed)(value).transform([&](std::size_t i) {
      return i < allowed.size() - 1 ? std::optional(static_cast<Choice>(i)) : std::nullopt;
    });
  };
}

// The values between commas.
template <typename Read>
auto list(Read read) {
  using Value = typename std::invoke_result_t<Read, std::string_view>::value_type;
  return [read](std::string_view text) -> Result<std::vector<Value>> {
    std::vector<Value> values;
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t comma = std::min(text.find(',', begin), text.size());
      ALCOVE_TRY(values.emplace_back(), read(text.substr(begin, comma - begin)));
      begin = comma + 1;
    }
    return values;
  };
}

// X,Y,Z, finite as floats too.
[[nodiscard]] Result<glm::dvec3> read_vector(std::string_view text);
// WIDTHxHEIGHT, each from 1 to 16384.
[[nodiscard]] Result<std::pair<std::uint32_t, std::uint32_t>> read_size(std::string_view text);

// Returns the shortest text that is parsed as the same number.
template <typename Number>
[[nodiscard]] std::string number_text(Number value) {
  return fmt::to_string(value);
}

// Returns the shortest text of a coordinate from which the same float is parsed. The text is in the
// space of the scene's file, which is `value` plus `origin`.
[[nodiscard]] std::string coordinate_text(float value, double origin);

}  // namespace alcove::sample
