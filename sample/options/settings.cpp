#include "options/settings.h"

#include <charconv>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "options/setting_table.h"

namespace alcove::sample {
namespace {

using passes::OcclusionSettings;
using Failure = tl::unexpected<std::string>;
using Json = nlohmann::ordered_json;

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

template <typename Choice>
std::string parse(const std::string& text, Choice& value) {
  std::string all;
  for (std::size_t i = 0; i < passes::kNames<Choice>.size(); ++i) {
    const std::string_view name = passes::kNames<Choice>[i];
    if (text == name) {
      value = static_cast<Choice>(i);
      return "";
    }
    all += (all.empty() ? "" : ", ") + std::string(name);
  }
  return "one of " + all;
}

Json show(float value) { return value; }
Json show(std::uint32_t value) { return value; }
template <typename Choice>
Json show(Choice value) {
  return std::string(passes::name_of(value));
}

tl::expected<void, std::string> set(OcclusionSettings& settings, const std::string& name,
                                    const std::string& value) {
  bool known = false;
  std::string wants;
  std::string names;
  for_each_setting(settings, [&](const SettingInfo& info, auto& field) {
    names += (names.empty() ? "" : ", ") + std::string(info.name);
    if (name == info.name) {
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

}  // namespace

tl::expected<OcclusionSettings, std::string> occlusion_settings(const OcclusionOptions& options,
                                                                const Scene& scene) {
  OcclusionSettings settings =
      passes::quality_settings(options.quality, options.radius.value_or(default_radius(scene)));
  for (const auto& [name, value] : options.set) {
    if (auto done = set(settings, name, value); !done) {
      return Failure(std::move(done.error()));
    }
  }
  return settings;
}

Json to_json(const OcclusionSettings& settings) {
  Json json;
  for_each_setting(
      settings, [&](const SettingInfo& info, const auto& field) { json[info.name] = show(field); });
  return json;
}

}  // namespace alcove::sample
