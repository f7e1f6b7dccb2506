#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <iterator>
#include <locale>
#include <sstream>
#include <string>

#include "alcove/passes/setting_table.h"
#include "work/number_text.h"

namespace alcove::passes {
namespace {

using Kind = SettingInfo::Kind;
using S = const AlcoveSettings&;

template <std::size_t kCount>
using Names = std::array<std::string_view, kCount>;
constexpr Names<2> kSwitch{"false", "true"};
constexpr Names<2> kEstimators{"horizons", "connected"};
constexpr Names<2> kWeightings{"cosine", "uniform"};
constexpr Names<2> kThicknessLimits{"radius", "back_faces"};
constexpr Names<3> kSpeculars{"none", "slices", "table"};
constexpr Names<3> kPrecisions{"unorm8", "float16", "float32"};

bool has_thickness(S s) { return s.estimator == ALCOVE_ESTIMATOR_CONNECTED; }

constexpr SettingInfo kTable[] = {
    {.name = "radius",
     .help = "Distance in scene units beyond which occluders do not count. A twentieth to a fifth "
             "of a room's height is usual.",
     .offset = offsetof(AlcoveSettings, radius),
     .kind = Kind::real,
     .range = {.above_minimum = true},
     .slider = {.minimum = 0.05f, .maximum = 10.0f}},
    {.name = "tile_size",
     .help =
         "Width of a tile in pixels. One pixel per tile is traced in each frame, and the filter "
         "and the history fill the others. 1 traces every pixel.",
     .offset = offsetof(AlcoveSettings, tile_size),
     .kind = Kind::whole,
     .range = {.minimum = 1, .maximum = 8, .power_of_two = true}},
    {.name = "slices",
     .help = "Slices (planes through the view direction) that are searched per traced pixel and "
             "frame. More slices reduce noise; the time grows in proportion.",
     .offset = offsetof(AlcoveSettings, slices),
     .kind = Kind::whole,
     .range = {.minimum = 1, .maximum = 64}},
    {.name = "steps",
     .help = "Depth samples in each of the two directions of a slice. More samples find thinner "
             "occluders.",
     .offset = offsetof(AlcoveSettings, steps),
     .kind = Kind::whole,
     .range = {.minimum = 2, .maximum = 64}},
    {.name = "estimator",
     .help = "Assumption about the thickness of occluders: infinite (horizons), or finite and "
             "without gaps between the samples of one surface (connected).",
     .offset = offsetof(AlcoveSettings, estimator),
     .kind = Kind::choice,
     .choices = kEstimators},
    {.name = "weighting",
     .help = "For the estimator horizons: weight of a direction in visibility, the cosine of its "
             "angle to the normal, or 1 (uniform).",
     .offset = offsetof(AlcoveSettings, weighting),
     .kind = Kind::choice,
     .choices = kWeightings,
     .matters = [](S s) { return s.estimator == ALCOVE_ESTIMATOR_HORIZONS; }},
    {.name = "thickness",
     .help = "Largest thickness of occluders as a fraction of the radius. Larger values darken.",
     .offset = offsetof(AlcoveSettings, thickness),
     .kind = Kind::real,
     .slider = {.maximum = 1.0f},
     .matters = has_thickness},
    {.name = "thickness_limit",
     .help = "What limits the thickness of occluders: the setting thickness (radius), or the back "
             "face behind them in a second depth buffer and, where there is none, the setting "
             "thickness (back_faces).",
     .offset = offsetof(AlcoveSettings, thickness_limit),
     .kind = Kind::choice,
     .choices = kThicknessLimits,
     .matters = has_thickness},
    {.name = "hidden_occlusion",
     .help = "Average fraction of the volume hidden behind occluders that is treated as solid. "
             "Raising it darkens corners behind foregrounds.",
     .offset = offsetof(AlcoveSettings, hidden_occlusion),
     .kind = Kind::real,
     .range = {.maximum = 1.0f},
     .matters = has_thickness},
    {.name = "depth_layers",
     .help = "Number of depth buffers that are searched for occluders. The second one holds the "
             "nearest front faces that the first one hides.",
     .offset = offsetof(AlcoveSettings, depth_layers),
     .kind = Kind::whole,
     .range = {.minimum = 1, .maximum = 2},
     .matters = has_thickness},
    {.name = "history_frames",
     .help = "Largest number of frames that the history averages while the image changes. After 16 "
             "frames without a change the limit is 127. 0 turns the history off.",
     .offset = offsetof(AlcoveSettings, history_frames),
     .kind = Kind::whole,
     .range = {.maximum = 127}},
    {.name = "static_noise",
     .help =
         "Gives every frame the same noise, for images that no temporal filter follows. Without "
         "it, noise changes from frame to frame. It has an effect with a history_frames of 0.",
     .offset = offsetof(AlcoveSettings, static_noise),
     .kind = Kind::choice,
     .choices = kSwitch,
     .matters = [](S s) { return s.history_frames == 0; }},
    {.name = "half_resolution",
     .help =
         "Filters and accumulates at half of the image's width and height, then upsamples: less "
         "time, larger error. It needs a tile_size above 1.",
     .offset = offsetof(AlcoveSettings, half_resolution),
     .kind = Kind::choice,
     .choices = kSwitch,
     .matters = [](S s) { return s.tile_size > 1; }},
    {.name = "specular",
     .help = "Method of specular occlusion: none, integration over the slices (slices, smallest "
             "error), or from visibility and the bent normal with a table (table).",
     .offset = offsetof(AlcoveSettings, specular),
     .kind = Kind::choice,
     .choices = kSpeculars},
    {.name = "precision",
     .help = "Format of intermediate results: 8-bit UNORM (unorm8), 16-bit floats (float16) or "
             "32-bit floats (float32).",
     .offset = offsetof(AlcoveSettings, precision),
     .kind = Kind::choice,
     .choices = kPrecisions},
    {.name = "power",
     .help = "Exponent that is applied to visibility before it is written. Above 1 darkens; 1 "
             "changes nothing.",
     .offset = offsetof(AlcoveSettings, power),
     .kind = Kind::real,
     .range = {.maximum = 16.0f, .above_minimum = true}},
    {.name = "intensity",
     .help = "Factor that is applied to occlusion (1 - visibility) before it is written. Above 1 "
             "darkens; 1 changes nothing.",
     .offset = offsetof(AlcoveSettings, intensity),
     .kind = Kind::real,
     .range = {.maximum = 16.0f}},
    {.name = "roughness",
     .help = "Perceptual roughness of pixels without a roughness texture.",
     .offset = offsetof(AlcoveSettings, roughness),
     .kind = Kind::real,
     .range = {.maximum = 1.0f},
     .of_material = true},
    {.name = "roughness_channel",
     .help = "Channel of the roughness texture that holds the roughness: 0 red to 3 alpha.",
     .offset = offsetof(AlcoveSettings, roughness_channel),
     .kind = Kind::whole,
     .range = {.maximum = 3},
     .of_material = true},
};
static_assert(sizeof(AlcoveSettings) == 4 * (1 + std::size(kTable)), "a field without a row");

bool is_allowed(S settings, const SettingInfo& info) {
  if (info.kind == Kind::real) return info.range.contains(setting_value<float>(settings, info));
  const auto number = setting_value<std::uint32_t>(settings, info);
  // A bool of C is true if it is not 0.
  if (info.choices.data() == kSwitch.data()) return true;
  return info.kind == Kind::choice ? number < info.choices.size() : info.range.contains(number);
}

}  // namespace

bool SettingRange::contains(double value) const {
  return std::isfinite(value) && value <= double{maximum} &&
         (above_minimum ? value > double{minimum} : value >= double{minimum}) &&
         (!power_of_two || std::has_single_bit(static_cast<std::uint32_t>(value)));
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

std::span<const SettingInfo> setting_table() { return kTable; }

std::string setting_text(const AlcoveSettings& settings, const SettingInfo& info) {
  if (info.kind == Kind::real) return number_text(setting_value<float>(settings, info));
  auto number = setting_value<std::uint32_t>(settings, info);
  if (info.choices.data() == kSwitch.data()) number = std::min(number, 1u);
  return number < info.choices.size() ? std::string(info.choices[number]) : std::to_string(number);
}

std::string allowed_text(const SettingInfo& info) {
  if (info.kind == Kind::real) return "a number, " + info.range.text();
  if (info.kind == Kind::whole) return "a whole number, " + info.range.text();
  std::string all(info.choices.front());
  for (std::size_t i = 1; i < info.choices.size(); ++i)
    all.append(i + 1 < info.choices.size() ? ", " : " or ").append(info.choices[i]);
  return all;
}

// Reads a number in the C locale's notation. Returns whether it is the whole text.
template <class Number>
bool read_number(std::string_view text, Number& number) {
#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 200000  // has no std::from_chars for float
  if constexpr (std::is_floating_point_v<Number>) {
    std::istringstream in{std::string(text)};
    in.imbue(std::locale::classic());
    return in >> std::noskipws >> number && in.peek() == std::istringstream::traits_type::eof();
  } else
#endif
  {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size();
  }
}

tl::expected<void, Error> parse_setting(AlcoveSettings& settings, std::string_view name,
                                        std::string_view value) {
  const auto* const info = std::ranges::find(kTable, name, &SettingInfo::name);
  if (info == std::end(kTable))
    return tl::unexpected(Error{"There is no setting '" + std::string(name) + "'."});
  AlcoveSettings changed = settings;
  const auto parse = [&](auto number) {
    const bool whole = read_number(value, number);
    set_setting(changed, *info, number);
    return whole;
  };
  bool good = false;
  if (info->kind == Kind::choice) {
    const auto choice = std::ranges::find(info->choices, value);
    good = choice != info->choices.end();
    set_setting(changed, *info, static_cast<std::uint32_t>(choice - info->choices.begin()));
  } else {
    good = info->kind == Kind::real ? parse(0.0f) : parse(std::uint32_t{0});
  }
  if (!good || !is_allowed(changed, *info)) {
    return tl::unexpected(Error{"The setting '" + std::string(name) + "' is " + std::string(value) +
                                "; it must be " + allowed_text(*info) + "."});
  }
  settings = changed;
  return {};
}

tl::expected<void, Error> validate(const AlcoveSettings& settings) {
  if (settings.struct_size != sizeof settings) {
    return tl::unexpected(Error{"AlcoveSettings::struct_size is " +
                                std::to_string(settings.struct_size) +
                                "; set it to sizeof(AlcoveSettings), which is " +
                                std::to_string(sizeof settings) + " here."});
  }
  for (const SettingInfo& info : kTable) {
    if (is_allowed(settings, info)) continue;
    return tl::unexpected(
        Error{"The setting '" + std::string(info.name) + "' is " + setting_text(settings, info) +
              "; it must be " +
              (info.kind == Kind::choice ? allowed_text(info) : info.range.text()) + "."});
  }
  if (settings.half_resolution != 0 && settings.tile_size < 2) {
    return tl::unexpected(Error{
        "The setting 'half_resolution' is true with a tile_size of 1; choose a tile_size of at "
        "least 2."});
  }
  return {};
}

}  // namespace alcove::passes
