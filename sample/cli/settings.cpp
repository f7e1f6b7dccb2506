#include "cli/settings.h"

#include <charconv>
#include <iomanip>
#include <sstream>
#include <string_view>
#include <utility>

#include "render/setting_table.h"

namespace alcove::sample {
namespace {

using passes::OcclusionSettings;
using Failure = tl::unexpected<std::string>;

// Each overload reads `text` into a setting; what it takes, when that fails.
std::string parse(const std::string& text, const SettingInfo& /*info*/, float& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole ? "" : "a number";
}

std::string parse(const std::string& text, const SettingInfo& info, std::uint32_t& value) {
  const auto least = static_cast<std::uint32_t>(info.low);
  const auto most = static_cast<std::uint32_t>(info.high);
  std::uint32_t read = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), read);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  if (!whole || read < least || read > most) {
    return "a whole number from " + std::to_string(least) + " to " + std::to_string(most);
  }
  value = read;
  return "";
}

template <typename Choice>
std::string parse(const std::string& text, const SettingInfo& /*info*/, Choice& value) {
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

// What a setting can be, where it is one of some names.
std::string choices(float /*value*/) { return ""; }
std::string choices(std::uint32_t /*value*/) { return ""; }
template <typename Choice>
std::string choices(Choice /*value*/) {
  const auto& names = passes::kNames<Choice>;
  std::string all(names.front());
  for (std::size_t i = 1; i < names.size(); ++i) {
    all += (i + 1 < names.size() ? ", " : " or ") + std::string(names[i]);
  }
  return (names.size() == 2 ? " Either " : " One of ") + all + ".";
}

// Sets one by its name; what to give instead, where that fails.
std::optional<std::string> set(OcclusionSettings& settings, const std::string& name,
                               const std::string& value) {
  bool known = false;
  std::string wanted;
  std::string names;
  for_each_setting(settings, [&](const SettingInfo& info, auto& field) {
    names += (names.empty() ? "" : ", ") + std::string(info.name);
    if (name == info.name) {
      known = true;
      wanted = parse(value, info, field);
    }
  });
  if (!known) {
    return "one of " + names;
  }
  return wanted.empty() ? std::nullopt : std::optional(wanted);
}

}  // namespace

std::optional<std::string> wanted_instead(const std::string& name, const std::string& value) {
  OcclusionSettings settings;
  return set(settings, name, value);
}

std::string settings_help() {
  constexpr int kColumn = 28;
  std::ostringstream text;
  text << "Settings, for --set NAME=VALUE:";
  const OcclusionSettings settings;
  for_each_setting(settings, [&](const SettingInfo& info, const auto& field) {
    text << "\n  " << std::left << std::setw(kColumn) << info.name << info.help << choices(field);
  });
  return text.str();
}

tl::expected<OcclusionSettings, std::string> occlusion_settings(const OcclusionOptions& options,
                                                                const Scene& scene) {
  OcclusionSettings settings =
      passes::quality_settings(options.quality, options.radius.value_or(default_radius(scene)));
  for (const auto& [name, value] : options.set) {
    if (const auto wanted = set(settings, name, value)) {
      return Failure("--set " + name + "=" + value + ": give " + *wanted);
    }
  }
  return settings;
}

}  // namespace alcove::sample
