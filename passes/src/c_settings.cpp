#include "c_settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <span>

namespace alcove::passes {
namespace {

// By number. A gap is no value.
constexpr std::array kEstimators{"horizons", "heuristic", "bitmask", "connected"};
constexpr std::array kWeightings{"cosine", "uniform"};
constexpr std::array kThicknessUnits{"radius", "distance", "back_faces"};
constexpr std::array kPatterns{"golden", "hilbert", "memo"};
constexpr std::array<const char*, 6> kSpeculars{nullptr, "slices",      "table",
                                                "cone",  "smooth_cone", "lagarde"};
constexpr std::array kPrecisions{"unorm8", "float16", "float32"};

// The two sets of enums have the same numbers.
template <typename Ours, typename Theirs>
constexpr bool same(Ours ours, Theirs theirs) {
  return static_cast<int>(ours) == static_cast<int>(theirs);
}
static_assert(same(Quality::low, ALCOVE_QUALITY_LOW) &&
              same(Quality::medium, ALCOVE_QUALITY_MEDIUM) &&
              same(Quality::high, ALCOVE_QUALITY_HIGH) &&
              same(Quality::ultra, ALCOVE_QUALITY_ULTRA) &&
              same(Quality::reference, ALCOVE_QUALITY_REFERENCE));
static_assert(same(Estimator::horizons, ALCOVE_ESTIMATOR_HORIZONS) &&
              same(Estimator::heuristic, ALCOVE_ESTIMATOR_HEURISTIC) &&
              same(Estimator::bitmask, ALCOVE_ESTIMATOR_BITMASK) &&
              same(Estimator::connected, ALCOVE_ESTIMATOR_CONNECTED));
static_assert(same(Weighting::cosine, ALCOVE_WEIGHTING_COSINE) &&
              same(Weighting::uniform, ALCOVE_WEIGHTING_UNIFORM));
static_assert(same(ThicknessUnit::radius, ALCOVE_THICKNESS_UNIT_RADIUS) &&
              same(ThicknessUnit::distance, ALCOVE_THICKNESS_UNIT_DISTANCE) &&
              same(ThicknessUnit::back_faces, ALCOVE_THICKNESS_UNIT_BACK_FACES));
static_assert(same(Pattern::golden, ALCOVE_PATTERN_GOLDEN) &&
              same(Pattern::hilbert, ALCOVE_PATTERN_HILBERT) &&
              same(Pattern::memo, ALCOVE_PATTERN_MEMO));
static_assert(same(Specular::slices, ALCOVE_SPECULAR_SLICES) &&
              same(Specular::table, ALCOVE_SPECULAR_TABLE) &&
              same(Specular::cone, ALCOVE_SPECULAR_CONE) &&
              same(Specular::smooth_cone, ALCOVE_SPECULAR_SMOOTH_CONE) &&
              same(Specular::lagarde, ALCOVE_SPECULAR_LAGARDE));
static_assert(same(Precision::unorm8, ALCOVE_PRECISION_UNORM8) &&
              same(Precision::float16, ALCOVE_PRECISION_FLOAT16) &&
              same(Precision::float32, ALCOVE_PRECISION_FLOAT32));

// The bits of an enum that C wrote: reading one that is no value is undefined in C++.
template <typename Theirs>
std::uint32_t number_of(const Theirs& value) {
  std::uint32_t number = 0;
  static_assert(sizeof value == sizeof number);
  std::memcpy(&number, &value, sizeof number);
  return number;
}

const char* name_of(std::span<const char* const> names, std::uint32_t number) {
  return number < names.size() ? names[number] : nullptr;
}

// Calls `visit(name, field)` for every number, and `visit(name, field, names)` for every enum.
template <typename Visit>
void for_each_setting(const AlcoveSettings& settings, const Visit& visit) {
  visit("radius", settings.radius);
  visit("slices", settings.slices);
  visit("steps", settings.steps);
  visit("estimator", settings.estimator, kEstimators);
  visit("weighting", settings.weighting, kWeightings);
  visit("thickness", settings.thickness);
  visit("thickness_unit", settings.thickness_unit, kThicknessUnits);
  visit("fill", settings.fill);
  visit("blend", settings.blend);
  visit("falloff", settings.falloff);
  visit("divisor", settings.divisor);
  visit("pattern", settings.pattern, kPatterns);
  visit("depth_mips", settings.depth_mips);
  visit("filter_reach", settings.filter_reach);
  visit("filter_tolerance_px", settings.filter_tolerance_px);
  visit("history_frames", settings.history_frames);
  visit("clamp_width", settings.clamp_width);
  visit("specular", settings.specular, kSpeculars);
  visit("roughness", settings.roughness);
  visit("roughness_channel", settings.roughness_channel);
  visit("precision", settings.precision, kPrecisions);
}

// Finds the first enum that has no such value.
struct FindUnknown {
  const char*& name;
  std::uint32_t& number;

  void operator()(const char* /*setting*/, float /*value*/) const {}
  void operator()(const char* /*setting*/, std::uint32_t /*value*/) const {}
  template <typename Theirs>
  void operator()(const char* setting, const Theirs& value,
                  std::span<const char* const> names) const {
    if (name == nullptr && name_of(names, number_of(value)) == nullptr) {
      name = setting;
      number = number_of(value);
    }
  }
};

// Lines of `name = value`, as far as there is room.
struct Print {
  char* text;
  std::size_t size;
  std::size_t& length;

  template <typename... Values>
  void line(const char* format, Values... values) const {
    const bool room = length < size;
    const int more =
        std::snprintf(room ? text + length : nullptr, room ? size - length : 0, format, values...);
    length += static_cast<std::size_t>(std::max(more, 0));
  }
  void operator()(const char* name, float value) const {
    line("%s = %g\n", name, static_cast<double>(value));
  }
  void operator()(const char* name, std::uint32_t value) const {
    line("%s = %u\n", name, static_cast<unsigned>(value));
  }
  template <typename Theirs>
  void operator()(const char* name, const Theirs& value, std::span<const char* const> names) const {
    line("%s = %s\n", name, name_of(names, number_of(value)));
  }
};

}  // namespace

tl::expected<GivenSettings, Failure> to_settings(const AlcoveSettings* given) {
  if (given == nullptr) {
    return invalid("There are no settings: alcoveGetSettings gives some.");
  }
  if (auto right = check_size(given->struct_size, sizeof *given, "AlcoveSettings"); !right) {
    return tl::unexpected(std::move(right.error()));
  }
  const char* unknown = nullptr;
  std::uint32_t number = 0;
  for_each_setting(*given, FindUnknown{unknown, number});
  if (unknown != nullptr) {
    return invalid("AlcoveSettings::" + std::string(unknown) + " is " + std::to_string(number) +
                   ", which is none of its values.");
  }
  GivenSettings result;
  result.specular = static_cast<Specular>(number_of(given->specular));
  result.settings = {.radius = given->radius,
                     .slices = given->slices,
                     .steps = given->steps,
                     .estimator = static_cast<Estimator>(number_of(given->estimator)),
                     .weighting = static_cast<Weighting>(number_of(given->weighting)),
                     .thickness = given->thickness,
                     .thickness_unit = static_cast<ThicknessUnit>(number_of(given->thickness_unit)),
                     .fill = given->fill,
                     .blend = given->blend,
                     .falloff = given->falloff,
                     .divisor = given->divisor,
                     .pattern = static_cast<Pattern>(number_of(given->pattern)),
                     .depth_mips = given->depth_mips,
                     .filter_reach = given->filter_reach,
                     .filter_tolerance_px = given->filter_tolerance_px,
                     .history_frames = given->history_frames,
                     .clamp_width = given->clamp_width,
                     .roughness = given->roughness,
                     .roughness_channel = given->roughness_channel,
                     .precision = static_cast<Precision>(number_of(given->precision))};
  return result;
}

AlcoveSettings from_settings(const OcclusionSettings& settings) {
  return {.struct_size = sizeof(AlcoveSettings),
          .radius = settings.radius,
          .slices = settings.slices,
          .steps = settings.steps,
          .estimator = static_cast<AlcoveEstimator>(settings.estimator),
          .weighting = static_cast<AlcoveWeighting>(settings.weighting),
          .thickness = settings.thickness,
          .thickness_unit = static_cast<AlcoveThicknessUnit>(settings.thickness_unit),
          .fill = settings.fill,
          .blend = settings.blend,
          .falloff = settings.falloff,
          .divisor = settings.divisor,
          .pattern = static_cast<AlcovePattern>(settings.pattern),
          .depth_mips = settings.depth_mips,
          .filter_reach = settings.filter_reach,
          .filter_tolerance_px = settings.filter_tolerance_px,
          .history_frames = settings.history_frames,
          .clamp_width = settings.clamp_width,
          .specular = settings.specular == Specular::none
                          ? ALCOVE_SPECULAR_SLICES
                          : static_cast<AlcoveSpecular>(settings.specular),
          .roughness = settings.roughness,
          .roughness_channel = settings.roughness_channel,
          .precision = static_cast<AlcovePrecision>(settings.precision)};
}

}  // namespace alcove::passes

using namespace alcove::passes;

AlcoveResult alcoveGetSettings(AlcoveQuality quality, float radius, AlcoveSettings* settings) {
  const std::uint32_t number = number_of(quality);
  if (settings == nullptr || settings->struct_size != sizeof *settings ||
      number > static_cast<std::uint32_t>(Quality::reference) || !std::isfinite(radius) ||
      radius <= 0.0f) {
    return ALCOVE_ERROR_INVALID_INPUT;
  }
  *settings = from_settings(quality_settings(static_cast<Quality>(number), radius));
  return ALCOVE_SUCCESS;
}

size_t alcovePrintSettings(const AlcoveSettings* settings, char* text, size_t size) {
  if (text != nullptr && size > 0) {
    text[0] = '\0';
  }
  if (text == nullptr && size > 0) {
    return 0;
  }
  const char* unknown = nullptr;
  std::uint32_t number = 0;
  if (settings == nullptr || settings->struct_size != sizeof *settings) {
    return 0;
  }
  for_each_setting(*settings, FindUnknown{unknown, number});
  if (unknown != nullptr) {
    return 0;
  }
  std::size_t length = 0;
  for_each_setting(*settings, Print{text, size, length});
  return length;
}
