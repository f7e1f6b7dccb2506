// The names of the values of the settings' enums, for files, sliders and messages.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "alcove/passes/settings.h"

namespace alcove::passes {

// kNames<Choice>: the names of the values of the enum `Choice`, in the order of the enum. Each is
// terminated by zero, so that data() is a C string.
template <typename Choice>
inline constexpr std::array<std::string_view, 0> kNames{};
template <>
inline constexpr auto kNames<bool> = std::to_array<std::string_view>({"false", "true"});
template <>
inline constexpr auto kNames<Quality> =
    std::to_array<std::string_view>({"console", "low", "medium", "high", "ultra", "reference"});
template <>
inline constexpr auto kNames<Estimator> = std::to_array<std::string_view>({"horizons",
                                                                           "connected"});
template <>
inline constexpr auto kNames<Weighting> = std::to_array<std::string_view>({"cosine", "uniform"});
template <>
inline constexpr auto kNames<ThicknessUnit> = std::to_array<std::string_view>({"radius",
                                                                               "back_faces"});
template <>
inline constexpr auto kNames<Specular> = std::to_array<std::string_view>({"none", "slices",
                                                                          "table"});
template <>
inline constexpr auto kNames<Precision> = std::to_array<std::string_view>({"unorm8", "float16",
                                                                           "float32"});

// Returns the name of a value.
template <typename Choice>
constexpr std::string_view name_of(Choice value) {
  return kNames<Choice>[static_cast<std::size_t>(value)];
}

// Returns all names of an enum in one text, for example "unorm8, float16 or float32".
template <typename Choice>
std::string names_text() {
  const auto& names = kNames<Choice>;
  std::string all(names.front());
  for (std::size_t i = 1; i < names.size(); ++i)
    all.append(i + 1 < names.size() ? ", " : " or ").append(names[i]);
  return all;
}

}  // namespace alcove::passes
