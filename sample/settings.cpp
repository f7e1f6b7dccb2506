#include "settings.h"

#include <array>
#include <charconv>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

namespace alcove::sample {
namespace {

using passes::OcclusionSettings;
using Failure = tl::unexpected<std::string>;
using Json = nlohmann::ordered_json;

constexpr std::array<std::pair<std::string_view, passes::Estimator>, 4> kEstimators{
    {{"horizons", passes::Estimator::horizons},
     {"heuristic", passes::Estimator::heuristic},
     {"bitmask", passes::Estimator::bitmask},
     {"connected", passes::Estimator::connected}}};
constexpr std::array<std::pair<std::string_view, passes::Weighting>, 2> kWeightings{
    {{"cosine", passes::Weighting::cosine}, {"uniform", passes::Weighting::uniform}}};
constexpr std::array<std::pair<std::string_view, passes::ThicknessUnit>, 3> kThicknessUnits{
    {{"radius", passes::ThicknessUnit::radius},
     {"distance", passes::ThicknessUnit::distance},
     {"back_faces", passes::ThicknessUnit::back_faces}}};
constexpr std::array<std::pair<std::string_view, passes::Pattern>, 3> kPatterns{
    {{"golden", passes::Pattern::golden},
     {"hilbert", passes::Pattern::hilbert},
     {"memo", passes::Pattern::memo}}};
constexpr std::array<std::pair<std::string_view, passes::Precision>, 3> kPrecisions{
    {{"unorm8", passes::Precision::unorm8},
     {"float16", passes::Precision::float16},
     {"float32", passes::Precision::float32}}};
constexpr std::array<std::pair<std::string_view, passes::Specular>, 6> kSpeculars{
    {{"none", passes::Specular::none},
     {"slices", passes::Specular::slices},
     {"table", passes::Specular::table},
     {"cone", passes::Specular::cone},
     {"smooth_cone", passes::Specular::smooth_cone},
     {"lagarde", passes::Specular::lagarde}}};
constexpr std::array<std::pair<std::string_view, bool>, 2> kBooleans{
    {{"false", false}, {"true", true}}};

// Each overload reads `text` into a setting; what it takes, when that fails.
std::string parse(const std::string& text, float& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole ? "" : "a number";
}

std::string parse(const std::string& text, std::uint32_t& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole ? "" : "a whole number";
}

template <typename Value, std::size_t size>
std::string parse_name(const std::string& text, Value& value,
                       const std::array<std::pair<std::string_view, Value>, size>& names) {
  std::string all;
  for (const auto& [name, meaning] : names) {
    if (text == name) {
      value = meaning;
      return "";
    }
    all += (all.empty() ? "" : ", ") + std::string(name);
  }
  return "one of " + all;
}

std::string parse(const std::string& text, passes::Estimator& value) {
  return parse_name(text, value, kEstimators);
}
std::string parse(const std::string& text, passes::Weighting& value) {
  return parse_name(text, value, kWeightings);
}
std::string parse(const std::string& text, passes::ThicknessUnit& value) {
  return parse_name(text, value, kThicknessUnits);
}
std::string parse(const std::string& text, passes::Pattern& value) {
  return parse_name(text, value, kPatterns);
}
std::string parse(const std::string& text, passes::Precision& value) {
  return parse_name(text, value, kPrecisions);
}
std::string parse(const std::string& text, passes::Specular& value) {
  return parse_name(text, value, kSpeculars);
}
std::string parse(const std::string& text, bool& value) {
  return parse_name(text, value, kBooleans);
}

template <typename Value, std::size_t size>
std::string name_of(Value value,
                    const std::array<std::pair<std::string_view, Value>, size>& names) {
  for (const auto& [name, meaning] : names) {
    if (meaning == value) {
      return std::string(name);
    }
  }
  return "";
}

Json show(float value) { return value; }
Json show(std::uint32_t value) { return value; }
Json show(bool value) { return value; }
Json show(passes::Estimator value) { return name_of(value, kEstimators); }
Json show(passes::Weighting value) { return name_of(value, kWeightings); }
Json show(passes::ThicknessUnit value) { return name_of(value, kThicknessUnits); }
Json show(passes::Pattern value) { return name_of(value, kPatterns); }
Json show(passes::Precision value) { return name_of(value, kPrecisions); }
Json show(passes::Specular value) { return name_of(value, kSpeculars); }

// Calls `visit(name, field)` for every setting.
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

tl::expected<void, std::string> set(OcclusionSettings& settings, const std::string& name,
                                    const std::string& value) {
  bool known = false;
  std::string wants;
  std::string names;
  for_each_setting(settings, [&](const char* setting, auto& field) {
    names += (names.empty() ? "" : ", ") + std::string(setting);
    if (name == setting) {
      known = true;
      wants = parse(value, field);
    }
  });
  if (!known) {
    return Failure("There is no setting '" + name + "'; --set knows " + names + ".");
  }
  if (!wants.empty()) {
    return Failure("--set " + name + "=" + value + ": " + name + " takes " + wants + ".");
  }
  return {};
}

passes::Quality to_quality(Quality quality) {
  switch (quality) {
    case Quality::kLow:
      return passes::Quality::low;
    case Quality::kMedium:
      return passes::Quality::medium;
    case Quality::kHigh:
      return passes::Quality::high;
    case Quality::kUltra:
      return passes::Quality::ultra;
    default:
      return passes::Quality::reference;
  }
}

}  // namespace

tl::expected<OcclusionSettings, std::string> occlusion_settings(const OcclusionOptions& options,
                                                                const Scene& scene) {
  OcclusionSettings settings = passes::quality_settings(
      to_quality(options.quality), options.radius.value_or(default_radius(scene)));
  for (const auto& [name, value] : options.set) {
    if (auto done = set(settings, name, value); !done) {
      return Failure(std::move(done.error()));
    }
  }
  return settings;
}

Json to_json(const OcclusionSettings& settings) {
  Json json;
  for_each_setting(settings,
                   [&](const char* name, const auto& field) { json[name] = show(field); });
  return json;
}

}  // namespace alcove::sample
