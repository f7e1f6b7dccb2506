#include "cli/settings.h"

#include <algorithm>
#include <cstdio>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>
#include <type_traits>
#include <utility>

#include "alcove/passes/setting_table.h"
#include "cli/option_value.h"
#include "gpu_cost/presets.h"
#include "support/printable.h"
#include "support/regular_file.h"

namespace alcove::sample {
namespace {

using passes::OcclusionSettings;
using passes::SettingGroup;
using passes::SettingInfo;
using Failure = tl::unexpected<std::string>;

// Returns the allowed values of a setting.
template <typename Value>
std::string allowed(const SettingInfo& info, Value /*value*/) {
  if constexpr (passes::kNames<Value>.empty())
    return info.range.text();
  else
    return passes::names_text<Value>();
}

// Parses `text` as the value of a setting. Returns an empty text, or, if `text` is not allowed, the
// allowed values for the error sentence.
template <typename Value>
std::string parse(const std::string& text, const SettingInfo& info, Value& value) {
  if constexpr (passes::kNames<Value>.empty()) {
    const auto number = parse_number<Value>(text);
    if (!number || !info.range.contains(*number))
      return (std::is_integral_v<Value> ? "a whole number, " : "a number, ") + info.range.text();
    value = *number;
  } else {
    const auto& names = passes::kNames<Value>;
    const auto found = std::ranges::find(names, text);
    if (found == names.end()) return allowed(info, value);
    value = static_cast<Value>(found - names.begin());
  }
  return "";
}

// Calls `visit(info, field)` for each setting that --set accepts: all except those of surfaces,
// which have options of their own, such as --roughness.
template <typename Settings, typename Visit>
void for_each_option(Settings& settings, const Visit& visit) {
  passes::for_each_setting(settings, [&](const SettingInfo& info, auto& field) {
    if (info.group != SettingGroup::surface) visit(info, field);
  });
}

// Changes one setting by its name. If that fails, returns the allowed names or values.
std::optional<std::string> set(OcclusionSettings& settings, const std::string& name,
                               const std::string& value) {
  bool known = false;
  std::string wanted;
  std::string names;
  for_each_option(settings, [&](const SettingInfo& info, auto& field) {
    names += (names.empty() ? "" : ", ") + std::string(info.name);
    if (name == info.name) {
      known = true;
      wanted = parse(value, info, field);
    }
  });
  if (!known) return "one of " + names;
  return wanted.empty() ? std::nullopt : std::optional(wanted);
}

}  // namespace

std::optional<std::string> wanted_instead(const std::string& name, const std::string& value) {
  OcclusionSettings settings;
  return set(settings, name, value);
}

std::string settings_help() {
  constexpr int kColumn = 22;
  std::ostringstream text;
  text << "Settings, for --set NAME=VALUE. Brackets hold what it may be, and the default:";
  const OcclusionSettings settings;
  for_each_option(settings, [&](const SettingInfo& info, const auto& field) {
    text << "\n  " << std::left << std::setw(kColumn) << info.name << info.help << " ["
         << allowed(info, field) << "; " << value_text(field) << "]";
  });
  return text.str();
}

Result<OcclusionSettings> occlusion_settings(const OcclusionOptions& options,
                                             float default_radius) {
  OcclusionSettings settings =
      passes::quality_settings(options.quality, options.radius.value_or(default_radius));
  for (const auto* list : {&options.file, &options.set}) {
    for (const auto& [name, value] : *list)
      if (const auto wanted = set(settings, name, value))
        return Failure("--set " + name + "=" + value + ": give " + *wanted);
  }
  if (const auto good = passes::validate(settings); !good)
    return Failure("--set: " + good.error().message);
  return settings;
}

Result<std::vector<std::pair<std::string, std::string>>> read_settings(const std::string& file) {
  constexpr std::size_t kMost = 64 << 10;  // bytes
  const auto opened = open_regular_file(file);
  if (!opened) return Failure("cannot read " + printable(file) + ": " + opened.error());
  std::string text(kMost + 1, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), opened->get()));
  const auto json = text.size() > kMost ? nlohmann::ordered_json()
                                        : nlohmann::ordered_json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("settings") || !json["settings"].is_object()) {
    return Failure(printable(file) +
                   " holds no settings; give a file that `alcove recommend --out` wrote");
  }
  std::vector<std::pair<std::string, std::string>> found;
  for (const auto& [name, value] : json["settings"].items()) {
    const std::string shown_value = value.is_string()         ? value.get<std::string>()
                                    : value.is_number_float() ? number_text(value.get<float>())
                                                              : value.dump();
    if (const auto wanted = wanted_instead(name, shown_value)) {
      return Failure(printable(file) + ": " + printable(name) + " is " + printable(shown_value) +
                     "; give " + *wanted);
    }
    found.emplace_back(name, shown_value);
  }
  return found;
}

std::vector<passes::Quality> chosen_presets(const OcclusionOptions& options) {
  return options.quality_given ? std::vector{options.quality} : presets();
}

}  // namespace alcove::sample
