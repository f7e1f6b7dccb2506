#include "c/settings.h"

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>
#include <utility>

#include "alcove/passes/fit_budget.h"
#include "alcove/passes/setting_table.h"
#include "c/failure.h"
#include "work/number_text.h"

namespace alcove::passes {
namespace {

// Enums of C++ and of C have the same numbers.
template <typename Ours, typename Theirs>
constexpr bool same(Ours ours, Theirs theirs) {
  return static_cast<int>(ours) == static_cast<int>(theirs);
}
static_assert(same(Quality::console, ALCOVE_QUALITY_CONSOLE) &&
              same(Quality::low, ALCOVE_QUALITY_LOW) &&
              same(Quality::medium, ALCOVE_QUALITY_MEDIUM) &&
              same(Quality::high, ALCOVE_QUALITY_HIGH) &&
              same(Quality::ultra, ALCOVE_QUALITY_ULTRA) &&
              same(Quality::reference, ALCOVE_QUALITY_REFERENCE));
static_assert(same(Estimator::horizons, ALCOVE_ESTIMATOR_HORIZONS) &&
              same(Estimator::connected, ALCOVE_ESTIMATOR_CONNECTED));
static_assert(same(Weighting::cosine, ALCOVE_WEIGHTING_COSINE) &&
              same(Weighting::uniform, ALCOVE_WEIGHTING_UNIFORM));
static_assert(same(ThicknessUnit::radius, ALCOVE_THICKNESS_UNIT_RADIUS) &&
              same(ThicknessUnit::back_faces, ALCOVE_THICKNESS_UNIT_BACK_FACES));
static_assert(same(Specular::slices, ALCOVE_SPECULAR_SLICES) &&
              same(Specular::table, ALCOVE_SPECULAR_TABLE));
static_assert(same(Precision::unorm8, ALCOVE_PRECISION_UNORM8) &&
              same(Precision::float16, ALCOVE_PRECISION_FLOAT16) &&
              same(Precision::float32, ALCOVE_PRECISION_FLOAT32));

// Calls `visit(field in C, field in C++)` for each setting that both have.
template <typename Theirs, typename Ours, typename Visit>
void for_each_pair(Theirs& theirs, Ours& ours, const Visit& visit) {
  visit(theirs.radius, ours.radius);
  visit(theirs.tile_size, ours.tile_size);
  visit(theirs.slices, ours.slices);
  visit(theirs.steps, ours.steps);
  visit(theirs.estimator, ours.estimator);
  visit(theirs.weighting, ours.weighting);
  visit(theirs.thickness, ours.thickness);
  visit(theirs.thickness_unit, ours.thickness_unit);
  visit(theirs.hidden_occlusion, ours.hidden_occlusion);
  visit(theirs.depth_layers, ours.depth_layers);
  visit(theirs.history_frames, ours.history_frames);
  visit(theirs.static_noise, ours.static_noise);
  visit(theirs.half_resolution, ours.half_resolution);
  visit(theirs.specular, ours.specular);
  visit(theirs.roughness, ours.roughness);
  visit(theirs.roughness_channel, ours.roughness_channel);
  visit(theirs.precision, ours.precision);
  visit(theirs.power, ours.power);
  visit(theirs.intensity, ours.intensity);
}

constexpr auto kToCpp = [](const auto& theirs, auto& ours) {
  using Ours = std::remove_reference_t<decltype(ours)>;
  if constexpr (std::is_enum_v<Ours>) {
    // A number that the enum does not have is kept, so that validate() refuses it.
    const std::uint32_t most = std::numeric_limits<std::underlying_type_t<Ours>>::max();
    ours = static_cast<Ours>(std::min(number_of(theirs), most));
  } else if constexpr (std::is_same_v<Ours, bool>) {
    ours = theirs != VK_FALSE;
  } else {
    ours = theirs;
  }
};

constexpr auto kToC = [](auto& theirs, const auto& ours) {
  theirs = static_cast<std::remove_reference_t<decltype(theirs)>>(ours);
};

bool is_quality(std::uint32_t number) { return number < kNames<Quality>.size(); }

template <typename Value>
std::string value_text(const Value& value) {
  if constexpr (std::is_enum_v<Value> || std::is_same_v<Value, bool>)
    return std::string(name_of(value));
  else if constexpr (std::is_same_v<Value, float>)
    return number_text(value);
  else
    return std::to_string(value);
}

Result fit(const AlcoveBudget* budget, const double* milliseconds, std::uint32_t count,
           AlcoveSettings* settings, std::uint32_t* changed) {
  if (budget == nullptr || changed == nullptr || (milliseconds == nullptr && count > 0))
    return invalid("There is no AlcoveBudget, no times or no place for the result.");
  if (auto right = check_size(budget->struct_size, sizeof *budget, "AlcoveBudget"); !right)
    return right;
  const Budget limits{budget->target_ms, budget->least_slices, budget->most_slices,
                      budget->least_steps, budget->most_steps};
  return to_settings(settings).and_then([&](const OcclusionSettings& known) -> Result {
    const auto fitted = fit_budget(limits, {milliseconds, count}, known);
    if (!fitted) {
      return invalid(fitted.error().message);
    }
    *changed = settings->slices != fitted->slices || settings->steps != fitted->steps ? 1 : 0;
    settings->slices = fitted->slices;
    settings->steps = fitted->steps;
    return {};
  });
}

}  // namespace

tl::expected<OcclusionSettings, Failure> to_settings(const AlcoveSettings* given) {
  if (given == nullptr) return invalid("There are no settings: alcoveGetSettings gives some.");
  if (auto right = check_size(given->struct_size, sizeof *given, "AlcoveSettings"); !right)
    return tl::unexpected(std::move(right.error()));
  OcclusionSettings settings;
  for_each_pair(*given, settings, kToCpp);
  if (settings.specular == Specular::none) {
    return invalid(
        "The setting 'specular' is 0; it must be a value of AlcoveSpecular. Without an image "
        "AlcoveView::specular nothing is computed for it.");
  }
  if (auto good = validate(settings); !good) return invalid(std::move(good.error().message));
  return settings;
}

AlcoveSettings from_settings(const OcclusionSettings& settings) {
  AlcoveSettings result{.struct_size = sizeof(AlcoveSettings)};
  for_each_pair(result, settings, kToC);
  if (settings.specular == Specular::none) result.specular = ALCOVE_SPECULAR_SLICES;
  return result;
}

}  // namespace alcove::passes

using namespace alcove::passes;

AlcoveResult alcoveGetSettings(AlcoveQuality quality, float radius, AlcoveSettings* settings) {
  return guarded([&]() -> Result {
    const std::uint32_t number = number_of(quality);
    if (settings == nullptr || settings->struct_size != sizeof *settings || !is_quality(number))
      return invalid("");
    const OcclusionSettings preset = quality_settings(static_cast<Quality>(number), radius);
    if (!validate(preset)) return invalid("");
    *settings = from_settings(preset);
    return {};
  });
}

size_t alcovePrintSettings(const AlcoveSettings* settings, char* text, size_t size) {
  copy_text("", text, size);
  std::size_t length = 0;
  guarded([&]() -> Result {
    return to_settings(settings).map([&](const OcclusionSettings& known) {
      std::string lines;
      for_each_setting(known, [&](const SettingInfo& info, const auto& value) {
        if (info.group != SettingGroup::output)
          lines += std::string(info.name) + " = " + value_text(value) + "\n";
      });
      length = copy_text(lines, text, size);
    });
  });
  return length;
}

AlcoveResult alcoveFitBudget(const AlcoveBudget* budget, const double* milliseconds, uint32_t count,
                             AlcoveSettings* settings, uint32_t* changed) {
  return guarded([&] { return fit(budget, milliseconds, count, settings, changed); });
}
