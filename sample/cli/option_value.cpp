#include "cli/option_value.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "support/printable.h"

namespace alcove::sample {

void OptionValue::refuse(const std::string& wanted) const {
  constexpr std::size_t kLongest = 80;  // bytes of an argument that a message repeats
  throw Mistake{option + " " + (text.empty() ? "''" : shortened(text, kLongest)) + ": give " +
                wanted};
}

double OptionValue::number(double low, double high, const std::string& wanted) const {
  return numbers(1, 1, low, high, wanted).front();
}

std::int64_t OptionValue::whole_number(std::int64_t low, std::int64_t high,
                                       const std::string& wanted) const {
  const auto value = parse_number<std::int64_t>(text);
  if (!value || *value < low || *value > high) refuse(wanted);
  return *value;
}

float OptionValue::length() const {
  using Limits = std::numeric_limits<float>;
  return static_cast<float>(
      number(Limits::denorm_min(), Limits::max(), "a length above 0, in the scene's units"));
}

glm::dvec3 OptionValue::vector() const {
  constexpr double kHuge = std::numeric_limits<float>::max();
  const auto v = numbers(3, 3, -kHuge, kHuge, "three numbers, such as 0,1.5,-2");
  return {v[0], v[1], v[2]};
}

std::vector<OptionValue> OptionValue::parts() const {
  std::vector<OptionValue> found;
  std::istringstream all(text + ",");
  for (std::string part; std::getline(all, part, ',');) found.push_back({option, part});
  return found;
}

std::vector<double> OptionValue::numbers(std::size_t fewest, std::size_t most, double low,
                                         double high, const std::string& wanted) const {
  std::vector<double> values;
  for (const OptionValue& part : parts()) {
    const auto value = parse_number<double>(part.text);
    if (!value || !(*value >= low && *value <= high)) refuse(wanted);
    values.push_back(*value);
  }
  if (values.size() < fewest || values.size() > most) refuse(wanted);
  return values;
}

std::pair<std::uint32_t, std::uint32_t> OptionValue::size() const {
  const std::string_view all = text;
  const std::size_t x = std::min(all.find('x'), all.size());
  const auto side = [&](std::string_view number) {
    const std::uint32_t pixels = parse_number<std::uint32_t>(number).value_or(0);
    if (pixels < 1 || pixels > 16384)
      refuse("WIDTHxHEIGHT in pixels, each from 1 to 16384, such as 960x540");
    return pixels;
  };
  return {side(all.substr(0, x)), side(all.substr(std::min(x + 1, all.size())))};
}

std::size_t OptionValue::one_of(std::span<const std::string_view> names) const {
  const auto found = std::ranges::find(names, text);
  if (found == names.end()) refuse(fmt::format("one of {}", fmt::join(names, ", ")));
  return static_cast<std::size_t>(found - names.begin());
}

std::string coordinate_text(float value, double origin) {
  if (origin == 0.0) return number_text(value);
  std::string text;
  for (int digits = 6; digits <= 17; ++digits) {
    text = fmt::format("{:.{}g}", origin + static_cast<double>(value), digits);
    if (static_cast<float>(std::strtod(text.c_str(), nullptr) - origin) == value) break;
  }
  return text;
}

}  // namespace alcove::sample
