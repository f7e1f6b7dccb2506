#include "cli/settings.h"

#include <algorithm>
#include <cstdio>
#include <iomanip>
#include <sstream>
#include <utility>

#include "alcove/passes/setting_table.h"
#include "cli/option_value.h"
#include "gpu_cost/presets.h"
#include "support/printable.h"
#include "support/regular_file.h"

namespace alcove::sample {
namespace {

using passes::SettingInfo;
using Failure = tl::unexpected<std::string>;

// The output that --set turns on beside the settings of the passes.
constexpr std::string_view kBentNormal = "bent_normal";

// Changes one setting by its name. If that fails, returns the allowed names or values. The settings
// of materials have options of their own, such as --roughness.
std::optional<std::string> set(OcclusionSettings& settings, const std::string& name,
                               const std::string& value) {
  if (name == kBentNormal) {
    settings.bent_normal = value == "true";
    return value == "true" || value == "false" ? std::nullopt : std::optional("false or true");
  }
  std::string names;
  for (const SettingInfo& info : passes::setting_table()) {
    if (info.of_material) continue;
    if (name == info.name) {
      return passes::parse_setting(settings, name, value)
                 ? std::nullopt
                 : std::optional(passes::allowed_text(info));
    }
    names += std::string(info.name) + ", ";
  }
  return "one of " + names + std::string(kBentNormal);
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
  for (const SettingInfo& info : passes::setting_table()) {
    if (info.of_material) continue;
    text << "\n  " << std::left << std::setw(kColumn) << info.name << info.help << " ["
         << (info.kind == SettingInfo::Kind::choice ? allowed_text(info) : info.range.text())
         << "; " << setting_text(settings, info) << "]";
  }
  text << "\n  " << std::left << std::setw(kColumn) << kBentNormal
       << "Also writes bent normals: the mean unoccluded direction of each pixel. [false or true; "
          "false]";
  return text.str();
}

Result<OcclusionSettings> occlusion_settings(const OcclusionOptions& options,
                                             float default_radius) {
  OcclusionSettings settings(options.quality, options.radius.value_or(default_radius));
  // The text was checked when it was read.
  (void)alcoveReadSettings(options.file.data(), options.file.size(), &settings, nullptr);
  settings.radius = options.radius.value_or(settings.radius);
  for (const auto& [name, value] : options.set)
    if (const auto wanted = set(settings, name, value))
      return Failure("--set " + name + "=" + value + ": give " + *wanted);
  if (const auto good = passes::validate(settings); !good)
    return Failure("--set: " + good.error().message);
  return settings;
}

Result<std::string> read_settings(const std::string& file) {
  constexpr std::size_t kMost = 64 << 10;  // bytes
  const auto opened = open_regular_file(file);
  if (!opened) return Failure("cannot read " + printable(file) + ": " + opened.error());
  std::string text(kMost, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), opened->get()));
  OcclusionSettings settings;
  char message[ALCOVE_MAX_MESSAGE];
  if (alcoveReadSettings(text.data(), text.size(), &settings, message) != ALCOVE_SUCCESS) {
    return Failure(printable(file) + ": " + message +
                   " Give a file that `alcove recommend --out` wrote.");
  }
  return text;
}

std::string settings_text(const OcclusionSettings& settings) {
  std::string text(alcovePrintSettings(&settings, nullptr, 0) + 1, '\0');
  text.resize(alcovePrintSettings(&settings, text.data(), text.size()));
  const std::size_t radius = text.find("radius = ");
  return text.erase(radius, text.find('\n', radius) + 1 - radius);
}

std::vector<AlcoveQuality> chosen_presets(const OcclusionOptions& options) {
  return options.quality_given ? std::vector{options.quality} : presets();
}

}  // namespace alcove::sample
