// The table of the fields of AlcoveSettings: names, descriptions and ranges. The library checks,
// prints and reads settings with it; the option `--set` and the help of the program `alcove`,
// report.json, the sliders of the window and the table of the README are made from it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "alcove/alcove_settings.h"
#include "alcove/alcove_view.h"
#include "alcove/passes/error.h"

namespace alcove::passes {

// The range of values of a numeric setting. Infinite values and NaN are never allowed.
struct SettingRange {
  float minimum = 0.0f;
  float maximum = std::numeric_limits<float>::infinity();  // infinity: no maximum
  bool above_minimum = false;                              // the minimum itself is excluded
  bool power_of_two = false;

  [[nodiscard]] bool contains(double value) const;
  // Returns a text that completes the words "it must be", for example "1 to 64", "above 0" or "1, 2
  // or 4".
  [[nodiscard]] std::string text() const;
};

struct SettingInfo {
  enum class Kind : std::uint8_t { real, whole, choice };  // float, uint32_t, or an enum or a bool
  const char* name;
  const char* help;    // one or more sentences
  std::size_t offset;  // of the field in AlcoveSettings
  Kind kind;
  std::span<const std::string_view> choices = {};  // the names of the values 0, 1, ...
  SettingRange range = {};                         // of a number
  SettingRange slider = {};                        // range of a slider, if `range` has no maximum
  // Returns whether the setting has an effect with these other settings. Null: it always has one.
  bool (*matters)(const AlcoveSettings& settings) = nullptr;
  bool of_material = false;  // a material parameter that is used if there is no image for it
};

// Each name is terminated by zero, so that data() is a C string.
inline constexpr auto kQualityNames =
    std::to_array<std::string_view>({"console", "low", "medium", "high", "ultra", "height_field"});

// Returns the settings, in the order in which they are printed.
[[nodiscard]] std::span<const SettingInfo> setting_table();

// Returns the field of a setting: a float for Kind::real, else a number.
template <typename Value>
[[nodiscard]] Value setting_value(const AlcoveSettings& settings, const SettingInfo& info) {
  Value value;
  static_assert(sizeof value == 4);
  std::memcpy(&value, reinterpret_cast<const char*>(&settings) + info.offset, sizeof value);
  return value;
}
template <typename Value>
void set_setting(AlcoveSettings& settings, const SettingInfo& info, Value value) {
  static_assert(sizeof value == 4);
  std::memcpy(reinterpret_cast<char*>(&settings) + info.offset, &value, sizeof value);
}

// Returns the value of a setting as text that parse_setting() reads.
[[nodiscard]] std::string setting_text(const AlcoveSettings& settings, const SettingInfo& info);

// Returns the allowed values as a text that completes the words "it must be", for example "a whole
// number, 1 to 64" or "horizons or connected".
[[nodiscard]] std::string allowed_text(const SettingInfo& info);

// Changes the setting of a name. Errors: a name that is no setting, or a value that is not allowed.
[[nodiscard]] tl::expected<void, Error> parse_setting(AlcoveSettings& settings,
                                                      std::string_view name,
                                                      std::string_view value);

// Checks every setting against its range, and settings that depend on each other. The error is a
// sentence with the setting's name, its value and the allowed values.
[[nodiscard]] tl::expected<void, Error> validate(const AlcoveSettings& settings);

// Returns the format of an output in a precision. Images of an engine may have others.
[[nodiscard]] constexpr VkFormat output_format(AlcoveImageRole role, AlcovePrecision precision) {
  const bool scalar = role == ALCOVE_IMAGE_VISIBILITY || role == ALCOVE_IMAGE_SPECULAR;
  if (precision == ALCOVE_PRECISION_UNORM8) {
    if (scalar) return VK_FORMAT_R8_UNORM;
    return role == ALCOVE_IMAGE_BENT_NORMAL ? VK_FORMAT_R8G8B8A8_SNORM : VK_FORMAT_R8G8B8A8_UNORM;
  }
  if (precision == ALCOVE_PRECISION_FLOAT16)
    return scalar ? VK_FORMAT_R16_SFLOAT : VK_FORMAT_R16G16B16A16_SFLOAT;
  return scalar ? VK_FORMAT_R32_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT;
}

// Returns whether the image BACK_DEPTH is read. If not, an engine need not draw back faces.
[[nodiscard]] constexpr bool needs_back_depth(const AlcoveSettings& settings) {
  return settings.estimator == ALCOVE_ESTIMATOR_CONNECTED &&
         settings.thickness_limit == ALCOVE_THICKNESS_LIMIT_BACK_FACES;
}

// Returns whether the image SECOND_DEPTH is read.
[[nodiscard]] constexpr bool needs_second_depth(const AlcoveSettings& settings) {
  return settings.estimator == ALCOVE_ESTIMATOR_CONNECTED && settings.depth_layers > 1;
}

// Returns the number of depth samples of a half-slice in the second layer; 0 without that layer. It
// shows only fragments of the hidden surfaces, so that a third of AlcoveSettings::steps suffices:
// sample/lab/README.md has the errors. More than 16 could lie less than a pixel apart.
[[nodiscard]] constexpr std::uint32_t second_layer_steps(const AlcoveSettings& settings) {
  if (!needs_second_depth(settings)) return 0;
  return std::clamp((settings.steps + 2) / 3, 2u, 16u);
}

// Returns the radius of the spatial filter in tiles, for pixels with fewer than two frames of
// history. Pixels with more history use a radius of 1. There is no filter (0) if every pixel is
// traced with 8 slices or more, whose noise is smaller than the detail that a filter would blur.
[[nodiscard]] constexpr std::uint32_t filter_radius(const AlcoveSettings& settings) {
  return settings.tile_size == 1 && settings.slices >= 8 ? 0 : 2;
}

}  // namespace alcove::passes
