#ifndef ALCOVE_SAMPLE_SETTING_NAMES_H_
#define ALCOVE_SAMPLE_SETTING_NAMES_H_

#include <array>
#include <string_view>
#include <utility>

#include "alcove/passes/occlusion.h"

// The occlusion settings by the names that --set, report.json and the window know them by.
namespace alcove::sample {

inline constexpr std::array<std::pair<std::string_view, passes::Estimator>, 4> kEstimators{
    {{"horizons", passes::Estimator::horizons},
     {"heuristic", passes::Estimator::heuristic},
     {"bitmask", passes::Estimator::bitmask},
     {"connected", passes::Estimator::connected}}};
inline constexpr std::array<std::pair<std::string_view, passes::Weighting>, 2> kWeightings{
    {{"cosine", passes::Weighting::cosine}, {"uniform", passes::Weighting::uniform}}};
inline constexpr std::array<std::pair<std::string_view, passes::ThicknessUnit>, 3> kThicknessUnits{
    {{"radius", passes::ThicknessUnit::radius},
     {"distance", passes::ThicknessUnit::distance},
     {"back_faces", passes::ThicknessUnit::back_faces}}};
inline constexpr std::array<std::pair<std::string_view, passes::Pattern>, 3> kPatterns{
    {{"golden", passes::Pattern::golden},
     {"hilbert", passes::Pattern::hilbert},
     {"memo", passes::Pattern::memo}}};
inline constexpr std::array<std::pair<std::string_view, passes::Precision>, 3> kPrecisions{
    {{"unorm8", passes::Precision::unorm8},
     {"float16", passes::Precision::float16},
     {"float32", passes::Precision::float32}}};
inline constexpr std::array<std::pair<std::string_view, passes::Specular>, 6> kSpeculars{
    {{"none", passes::Specular::none},
     {"slices", passes::Specular::slices},
     {"table", passes::Specular::table},
     {"cone", passes::Specular::cone},
     {"smooth_cone", passes::Specular::smooth_cone},
     {"lagarde", passes::Specular::lagarde}}};
inline constexpr std::array<std::pair<std::string_view, bool>, 2> kBooleans{
    {{"false", false}, {"true", true}}};

// The choices that a setting has.
constexpr const auto& choices(passes::Estimator) { return kEstimators; }
constexpr const auto& choices(passes::Weighting) { return kWeightings; }
constexpr const auto& choices(passes::ThicknessUnit) { return kThicknessUnits; }
constexpr const auto& choices(passes::Pattern) { return kPatterns; }
constexpr const auto& choices(passes::Precision) { return kPrecisions; }
constexpr const auto& choices(passes::Specular) { return kSpeculars; }
constexpr const auto& choices(bool) { return kBooleans; }

template <typename Choice>
std::string_view name_of_choice(Choice value) {
  for (const auto& [name, meaning] : choices(value)) {
    if (meaning == value) {
      return name;
    }
  }
  return "";
}

// Calls `visit(name, field)` for every setting but roughness, which is the surfaces', and
// visibility, which the sample always draws.
template <typename Settings, typename Visit>
void for_each_setting(Settings& settings, const Visit& visit) {
  visit("radius", settings.radius);
  visit("slices", settings.slices);
  visit("steps", settings.steps);
  visit("estimator", settings.estimator);
  visit("weighting", settings.weighting);
  visit("thickness", settings.thickness);
  visit("thickness_unit", settings.thickness_unit);
  visit("fill", settings.fill);
  visit("blend", settings.blend);
  visit("falloff", settings.falloff);
  visit("divisor", settings.divisor);
  visit("pattern", settings.pattern);
  visit("depth_mips", settings.depth_mips);
  visit("filter_reach", settings.filter_reach);
  visit("filter_tolerance_px", settings.filter_tolerance_px);
  visit("history_frames", settings.history_frames);
  visit("clamp_width", settings.clamp_width);
  visit("bent_normal", settings.bent_normal);
  visit("specular", settings.specular);
  visit("precision", settings.precision);
}

}  // namespace alcove::sample

#endif  // ALCOVE_SAMPLE_SETTING_NAMES_H_
