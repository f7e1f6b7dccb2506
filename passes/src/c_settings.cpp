#include "c_settings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>
#include <type_traits>
#include <utility>

#include "alcove/passes/setting_names.h"
#include "number_text.h"

namespace alcove::passes {
namespace {

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
              same(Pattern::paper, ALCOVE_PATTERN_MEMO));
static_assert(same(Specular::slices, ALCOVE_SPECULAR_SLICES) &&
              same(Specular::table, ALCOVE_SPECULAR_TABLE) &&
              same(Specular::cone, ALCOVE_SPECULAR_CONE) &&
              same(Specular::smooth_cone, ALCOVE_SPECULAR_SMOOTH_CONE) &&
              same(Specular::lagarde, ALCOVE_SPECULAR_LAGARDE));
static_assert(same(Precision::unorm8, ALCOVE_PRECISION_UNORM8) &&
              same(Precision::float16, ALCOVE_PRECISION_FLOAT16) &&
              same(Precision::float32, ALCOVE_PRECISION_FLOAT32));

// Calls `visit(name, value in C, value in C++)` for every setting that both have.
template <typename Theirs, typename Ours, typename Visit>
void for_each_setting(Theirs& theirs, Ours& ours, const Visit& visit) {
  visit("radius", theirs.radius, ours.radius);
  visit("slices", theirs.slices, ours.slices);
  visit("steps", theirs.steps, ours.steps);
  visit("estimator", theirs.estimator, ours.estimator);
  visit("weighting", theirs.weighting, ours.weighting);
  visit("thickness", theirs.thickness, ours.thickness);
  visit("thickness_unit", theirs.thickness_unit, ours.thickness_unit);
  visit("hidden_occlusion", theirs.hidden_occlusion, ours.hidden_occlusion);
  visit("depth_layers", theirs.depth_layers, ours.depth_layers);
  visit("blend", theirs.blend, ours.blend);
  visit("falloff", theirs.falloff, ours.falloff);
  visit("tile_size", theirs.tile_size, ours.tile_size);
  visit("pattern", theirs.pattern, ours.pattern);
  visit("filter_radius", theirs.filter_radius, ours.filter_radius);
  visit("filter_tolerance_px", theirs.filter_tolerance_px, ours.filter_tolerance_px);
  visit("history_frames", theirs.history_frames, ours.history_frames);
  visit("clamp_width", theirs.clamp_width, ours.clamp_width);
  visit("specular", theirs.specular, ours.specular);
  visit("roughness", theirs.roughness, ours.roughness);
  visit("roughness_channel", theirs.roughness_channel, ours.roughness_channel);
  visit("precision", theirs.precision, ours.precision);
  visit("power", theirs.power, ours.power);
  visit("intensity", theirs.intensity, ours.intensity);
}

// An enum that has no such value.
struct Unknown {
  const char* setting;
  std::uint32_t number;
};

// Copies from C, and says where it cannot.
struct ReadSetting {
  std::optional<Unknown>& unknown;

  template <typename Theirs, typename Ours>
  void operator()(const char* name, const Theirs& theirs, Ours& ours) const {
    if constexpr (std::is_enum_v<Ours>) {
      const std::uint32_t number = number_of(theirs);
      // In C an output that nobody wants has no image; there is no value for it.
      const bool none = std::is_same_v<Ours, Specular> && number == 0;
      if (number < kNames<Ours>.size() && !none) {
        ours = static_cast<Ours>(number);
      } else if (!unknown) {
        unknown = {name, number};
      }
    } else {
      ours = theirs;
    }
  }
};

tl::expected<OcclusionSettings, Unknown> read(const AlcoveSettings& given) {
  OcclusionSettings settings;
  std::optional<Unknown> unknown;
  for_each_setting(given, settings, ReadSetting{unknown});
  if (unknown) {
    return tl::unexpected(*unknown);
  }
  return settings;
}

// Lines of `name = value`, as far as there is room.
struct Print {
  char* text;
  std::size_t size;
  std::size_t& length;

  void line(const char* name, const char* value) const {
    const bool room = length < size;
    const int more = std::snprintf(room ? text + length : nullptr, room ? size - length : 0,
                                   "%s = %s\n", name, value);
    length += static_cast<std::size_t>(std::max(more, 0));
  }
  template <typename Theirs, typename Ours>
  void operator()(const char* name, const Theirs& /*theirs*/, const Ours& ours) const {
    if constexpr (std::is_enum_v<Ours>) {
      line(name, name_of(ours).data());
    } else if constexpr (std::is_same_v<Ours, float>) {
      line(name, number_text(ours).c_str());
    } else {
      line(name, std::to_string(ours).c_str());
    }
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
  auto settings = read(*given);
  if (!settings) {
    const auto [setting, number] = settings.error();
    return invalid("AlcoveSettings::" + std::string(setting) + " is " + std::to_string(number) +
                   ", which is none of its values.");
  }
  const Specular specular = std::exchange(settings->specular, Specular::none);
  return GivenSettings{*settings, specular};
}

AlcoveSettings from_settings(const OcclusionSettings& settings) {
  AlcoveSettings result{.struct_size = sizeof(AlcoveSettings)};
  for_each_setting(result, settings, [](const char* /*name*/, auto& theirs, const auto& ours) {
    theirs = static_cast<std::remove_reference_t<decltype(theirs)>>(ours);
  });
  if (settings.specular == Specular::none) {
    result.specular = ALCOVE_SPECULAR_SLICES;
  }
  return result;
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
  if (settings == nullptr || settings->struct_size != sizeof *settings) {
    return 0;
  }
  const auto known = read(*settings);
  if (!known) {
    return 0;
  }
  std::size_t length = 0;
  for_each_setting(*settings, *known, Print{text, size, length});
  return length;
}
