#include "cli/settings.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstdio>
#include <iomanip>
#include <limits>
#include <sstream>

#include "alcove/passes/setting_table.h"
#include "gpu_cost/presets.h"
#include "support/printable.h"
#include "support/regular_file.h"

namespace alcove::sample {
namespace {

using passes::SettingInfo;

// The output that --set turns on beside the settings of the passes.
constexpr std::string_view kBentNormal = "bent_normal";

void apply(const SettingChange& change, OcclusionSettings& settings) {
  if (change.setting != nullptr)
    passes::set_setting(settings, *change.setting, change.value);
  else
    settings.bent_normal = change.value != 0;
}

}  // namespace

Result<SettingChange> read_change(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0 || equals + 1 == text.size())
    return Failure("name=value, such as slices=2");
  const std::string_view name = text.substr(0, equals);
  const std::string_view value = text.substr(equals + 1);
  if (name == kBentNormal) {
    if (value != "true" && value != "false") return Failure("false or true");
    return SettingChange{nullptr, value == "true"};
  }
  std::string names;
  for (const SettingInfo& info : passes::setting_table()) {
    if (info.of_material) continue;  // has an option of its own, such as --roughness
    if (name != info.name) {
      names += std::string(info.name) + ", ";
      continue;
    }
    OcclusionSettings settings;
    if (!passes::parse_setting(settings, name, value)) return Failure(passes::allowed_text(info));
    return SettingChange{&info, passes::setting_value<std::uint32_t>(settings, info)};
  }
  return Failure("one of " + names + std::string(kBentNormal));
}

std::string change_text(const SettingChange& change) {
  if (change.setting == nullptr)
    return fmt::format("{}={}", kBentNormal, change.value != 0 ? "true" : "false");
  OcclusionSettings settings;
  apply(change, settings);
  return fmt::format("{}={}", change.setting->name, setting_text(settings, *change.setting));
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
  OcclusionSettings settings =
      options.file.value_or(OcclusionSettings(options.quality.value_or(ALCOVE_QUALITY_MEDIUM)));
  const bool has_radius = options.file && options.file->radius > 0.0f;
  settings.radius = options.radius.value_or(has_radius ? options.file->radius : default_radius);
  for (const SettingChange& change : options.set) apply(change, settings);
  if (const auto good = passes::validate(settings); !good)
    return Failure("--set: " + good.error().message);
  return settings;
}

bool changes_radius(const OcclusionOptions& options) {
  return std::ranges::any_of(options.set, [](const SettingChange& change) {
    return change.setting != nullptr && std::string_view(change.setting->name) == "radius";
  });
}

std::string radius_source(const OcclusionOptions& options) {
  if (options.radius) return "--radius";
  if (changes_radius(options)) return "--set radius";
  return options.file && options.file->radius > 0.0f ? "the file of --settings" : "";
}

std::vector<std::string> ineffective_changes(const OcclusionOptions& options,
                                             const OcclusionSettings& settings) {
  std::vector<std::string> sentences;
  for (const SettingChange& change : options.set)
    if (change.setting != nullptr && change.setting->matters != nullptr &&
        !change.setting->matters(settings))
      sentences.push_back(fmt::format("--set {} has no effect with the other settings: {}",
                                      change_text(change), change.setting->help));
  return sentences;
}

Result<OcclusionSettings> read_settings(std::string_view file) {
  constexpr std::size_t kMost = 64 << 10;  // bytes
  constexpr float kNone = std::numeric_limits<float>::min();
  const auto wrong = [](const std::string& reason) {
    return Failure("a file that `alcove recommend --out` wrote (" + reason + ")");
  };
  const auto opened = open_regular_file(std::string(file));
  if (!opened) return wrong("this " + opened.error());
  std::string text(kMost, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), opened->get()));
  OcclusionSettings settings(ALCOVE_QUALITY_MEDIUM, kNone);
  char message[ALCOVE_MAX_MESSAGE];
  if (alcoveReadSettings(text.data(), text.size(), &settings, message) != ALCOVE_SUCCESS)
    return wrong(printable(message));
  if (text.find('=') == std::string::npos) return wrong("this names no setting");
  if (settings.radius == kNone) settings.radius = 0.0f;
  return settings;
}

std::string settings_text(const Choice& choice) {
  const OcclusionSettings& settings = choice.settings;
  std::string text(alcovePrintSettings(&settings, nullptr, 0) + 1, '\0');
  text.resize(alcovePrintSettings(&settings, text.data(), text.size()));
  const std::size_t radius = text.find("radius = ");
  text.erase(radius, text.find('\n', radius) + 1 - radius);
  if (choice.guard_band == 0.0) return text;
  return fmt::format(
             "# With a guard band of {0:g} % of the image's height: --guard-band {0:g}, or in a "
             "host an image with a border and AlcoveView::written_area.\n",
             choice.guard_band) +
         text;
}

std::vector<AlcoveQuality> chosen_presets(const OcclusionOptions& options) {
  return options.quality ? std::vector{*options.quality} : presets();
}

}  // namespace alcove::sample
