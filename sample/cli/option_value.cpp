#include "cli/option_value.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>

#include "support/printable.h"

namespace alcove::sample {
namespace {

std::optional<double> number_of(const std::string& text) {
  std::size_t used = 0;
  try {
    const double value = std::stod(text, &used);
    return used == text.size() && !std::isnan(value) ? std::optional(value) : std::nullopt;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

// Returns the numbers between commas, or an empty list if one of them is malformed.
std::vector<double> numbers_of(const std::string& text) {
  std::vector<double> values;
  std::size_t start = 0;
  while (start <= text.size()) {
    const std::size_t comma = std::min(text.find(',', start), text.size());
    const auto value = number_of(text.substr(start, comma - start));
    if (!value) return {};
    values.push_back(*value);
    start = comma + 1;
  }
  return values;
}

bool is_positive(double value) { return std::isfinite(value) && value > 0.0; }

}  // namespace

void OptionValue::refuse(const std::string& wanted) const {
  constexpr std::size_t kLongest = 80;  // bytes of an argument that a message repeats
  throw Mistake{option + " " + (text.empty() ? "''" : shortened(text, kLongest)) + ": give " +
                wanted};
}

double OptionValue::number(double low, double high, const std::string& wanted) const {
  const auto value = number_of(text);
  if (!value || !(*value >= low && *value <= high)) refuse(wanted);
  return *value;
}

std::int64_t OptionValue::whole_number(std::int64_t low, std::int64_t high,
                                       const std::string& wanted) const {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  if (!whole || value < low || value > high) refuse(wanted);
  return value;
}

double OptionValue::positive(const std::string& wanted) const {
  const auto value = number_of(text);
  if (!value || !is_positive(*value)) refuse(wanted);
  return *value;
}

float OptionValue::length() const {
  const std::string wanted = "a length above 0, in the scene's units";
  const auto value = static_cast<float>(positive(wanted));
  if (!is_positive(value)) refuse(wanted);
  return value;
}

glm::dvec3 OptionValue::vector() const {
  const std::vector<double> v = numbers_of(text);
  if (v.size() != 3 || !std::isfinite(static_cast<float>(v[0] + v[1] + v[2])) ||
      !std::isfinite(static_cast<float>(v[0])) || !std::isfinite(static_cast<float>(v[1])) ||
      !std::isfinite(static_cast<float>(v[2])))
    refuse("three numbers, such as 0,1.5,-2");
  return {v[0], v[1], v[2]};
}

std::vector<float> OptionValue::numbers(std::size_t most, float low, float high,
                                        const std::string& wanted) const {
  const std::vector<double> typed = numbers_of(text);
  std::vector<float> values(typed.begin(), typed.end());
  const bool within =
      std::ranges::all_of(values, [&](float value) { return value >= low && value <= high; });
  if (values.empty() || values.size() > most || !within) refuse(wanted);
  return values;
}

std::pair<std::uint32_t, std::uint32_t> OptionValue::size() const {
  constexpr unsigned long kLargest = 16384;
  unsigned long width = 0, height = 0;
  int used = 0;
  const bool fits = text.size() < 16 &&
                    text.find_first_not_of("0123456789x") == std::string::npos &&
                    std::sscanf(text.c_str(), "%lux%lu%n", &width, &height, &used) == 2 &&
                    static_cast<std::size_t>(used) == text.size();
  if (!fits || width < 1 || height < 1 || width > kLargest || height > kLargest)
    refuse("WIDTHxHEIGHT in pixels, each from 1 to 16384, such as 960x540");
  return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

std::size_t OptionValue::one_of(std::span<const std::string_view> names) const {
  const auto found = std::ranges::find(names, text);
  if (found == names.end()) refuse(fmt::format("one of {}", fmt::join(names, ", ")));
  return static_cast<std::size_t>(found - names.begin());
}

std::string shown_coordinate(float value, double origin) {
  if (origin == 0.0) return shown(value);
  std::string text;
  for (int digits = 6; digits <= 17; ++digits) {
    text = fmt::format("{:.{}g}", origin + static_cast<double>(value), digits);
    if (static_cast<float>(std::strtod(text.c_str(), nullptr) - origin) == value) break;
  }
  return text;
}

std::string shown(float value) {
  std::array<char, 32> digits{};
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  return {digits.data(), end};
}

}  // namespace alcove::sample
