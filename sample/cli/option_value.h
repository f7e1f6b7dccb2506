#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "support/glm.h"

namespace alcove::sample {

// A mistake in the command line, in a sentence. Thrown within parse_options only, as CLI11's own
// errors are.
struct Mistake {
  std::string text;
};

// A value as it was typed, and the option that it was typed for. Each conversion refuses what it
// cannot take; `wanted` completes the sentence "give ...".
struct OptionValue {
  std::string option;
  std::string text;

  [[noreturn]] void refuse(const std::string& wanted) const;

  // Within [low, high].
  double number(double low, double high, const std::string& wanted) const;
  std::int64_t whole_number(std::int64_t low, std::int64_t high, const std::string& wanted) const;
  // Finite and above 0.
  double positive(const std::string& wanted) const;
  // A finite length above 0, in the scene's units.
  float length() const;
  glm::dvec3 vector() const;  // finite as floats too
  // Numbers between commas, at least one and at most `most`, each within [low, high].
  std::vector<float> numbers(std::size_t most, float low, float high,
                             const std::string& wanted) const;
  // Pixels, each of WIDTHxHEIGHT from 1 to 16384.
  std::pair<std::uint32_t, std::uint32_t> size() const;
  // Which of the names.
  std::size_t one_of(std::span<const std::string_view> names) const;
};

// The shortest text that is parsed as the same float.
[[nodiscard]] std::string shown(float value);

// A coordinate in the space of the scene's file, from which `origin` was subtracted: the shortest
// text that gives the same float again.
[[nodiscard]] std::string shown_coordinate(float value, double origin);

}  // namespace alcove::sample
