#include "alcove/passes/settings.h"

#include <bit>
#include <cmath>
#include <type_traits>

#include "alcove/passes/setting_table.h"
#include "work/number_text.h"

namespace alcove::passes {
namespace {

// Returns the end of the sentence "The setting 'slices' is ..." for a value that is not allowed, or
// an empty text if the value is allowed.
template <typename Value>
std::string complaint(const SettingInfo& info, const Value& value) {
  if constexpr (std::is_same_v<Value, float>) {
    return info.range.contains(value)
               ? ""
               : number_text(value) + "; it must be " + info.range.text() + ".";
  } else if constexpr (std::is_same_v<Value, std::uint32_t>) {
    return info.range.contains(value)
               ? ""
               : std::to_string(value) + "; it must be " + info.range.text() + ".";
  } else if constexpr (std::is_enum_v<Value>) {
    const auto number = static_cast<std::size_t>(value);
    return number < kNames<Value>.size()
               ? ""
               : std::to_string(number) + "; it must be " + names_text<Value>() + ".";
  } else {
    return "";  // a bool
  }
}

tl::expected<void, Error> check_ranges(const OcclusionSettings& settings) {
  tl::expected<void, Error> result;
  for_each_setting(settings, [&](const SettingInfo& info, const auto& value) {
    if (!result) return;
    if (const std::string said = complaint(info, value); !said.empty())
      result = tl::unexpected(Error{"The setting '" + std::string(info.name) + "' is " + said});
  });
  return result;
}

}  // namespace

bool SettingRange::contains(float value) const {
  return std::isfinite(value) && value <= maximum &&
         (above_minimum ? value > minimum : value >= minimum);
}

bool SettingRange::contains(std::uint32_t value) const {
  return contains(static_cast<float>(value)) && (!power_of_two || std::has_single_bit(value));
}

std::string SettingRange::text() const {
  if (power_of_two) {
    std::string all = number_text(minimum);
    for (float value = minimum * 2.0f; value <= maximum; value *= 2.0f)
      all += (value < maximum ? ", " : " or ") + number_text(value);
    return all;
  }
  const std::string low = number_text(minimum);
  if (std::isinf(maximum)) return (above_minimum ? "above " : "at least ") + low + " and finite";
  return (above_minimum ? "above " + low + " and at most " : low + " to ") + number_text(maximum);
}

OcclusionSettings quality_settings(Quality quality, float radius) {
  OcclusionSettings settings;
  settings.radius = radius;
  switch (quality) {
    case Quality::console:
      settings.tile_size = 8;
      settings.slices = 1;
      settings.steps = 8;
      settings.half_resolution = true;
      break;
    case Quality::low:
      settings.slices = 1;
      settings.steps = 8;
      break;
    case Quality::medium:
      break;
    case Quality::high:
      settings.tile_size = 2;
      break;
    case Quality::ultra:
      settings.tile_size = 2;
      settings.steps = 10;
      settings.depth_layers = 2;
      break;
    case Quality::reference:
      settings.tile_size = 1;
      settings.slices = 32;
      settings.steps = 64;
      settings.history_frames = 0;
      settings.precision = Precision::float32;
      settings.estimator = Estimator::horizons;
      break;
  }
  return settings;
}

tl::expected<void, Error> validate(const OcclusionSettings& settings) {
  if (auto good = check_ranges(settings); !good) return good;
  if (settings.half_resolution && settings.tile_size < 2) {
    return tl::unexpected(Error{
        "The setting 'half_resolution' is true with a tile_size of 1; choose a tile_size of at "
        "least 2."});
  }
  return {};
}

}  // namespace alcove::passes
