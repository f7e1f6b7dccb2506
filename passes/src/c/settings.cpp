// The functions on settings.
#include <algorithm>
#include <string>

#include "alcove/alcove.h"
#include "alcove/passes/setting_table.h"
#include "c/failure.h"
#include "work/number_text.h"

namespace alcove::passes {
namespace {

constexpr std::size_t kMostShown = 60;  // bytes of the text in a sentence

// Returns the beginning of a text for a sentence, without bytes that cannot be printed.
std::string shown(std::string_view text) {
  std::string result(text.substr(0, kMostShown));
  for (char& byte : result) byte = byte >= ' ' && byte <= '~' ? byte : '?';
  return result;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r";
  const std::size_t first = text.find_first_not_of(kSpace);
  return first == std::string_view::npos
             ? std::string_view()
             : text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

Result check(const AlcoveSettings* settings) {
  if (settings == nullptr) return invalid("There are no settings: alcoveGetSettings gives some.");
  return validate(*settings);
}

// Changes the setting that a line names.
Result read_line(std::string_view line, AlcoveSettings& settings) {
  const std::size_t equals = line.find('=');
  if (equals == std::string_view::npos) {
    return invalid("The line '" + shown(line) +
                   "' of the settings is not of the form 'name = value'.");
  }
  // A value that is cut is still none that a setting allows.
  const std::string name = shown(trimmed(line.substr(0, equals)));
  const std::string value = shown(trimmed(line.substr(equals + 1)));
  return parse_setting(settings, name, value);
}

Result read(const char* text, std::size_t length, AlcoveSettings* settings) {
  if (text == nullptr) return invalid("There is no text of settings.");
  if (auto good = check(settings); !good) return good;
  AlcoveSettings changed = *settings;
  std::string_view rest(text, length);
  while (!rest.empty()) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    const std::string_view content = trimmed(line);
    if (content.empty() || content.front() == '#') continue;
    if (auto good = read_line(line, changed); !good) return good;
  }
  return check(&changed).map([&] { *settings = changed; });
}

}  // namespace
}  // namespace alcove::passes

using namespace alcove::passes;

AlcoveResult alcoveGetSettings(AlcoveQuality quality, float radius, AlcoveSettings* settings) {
  if (settings == nullptr || settings->struct_size != sizeof *settings)
    return ALCOVE_ERROR_INVALID_INPUT;
  AlcoveSettings preset{.struct_size = sizeof preset,
                        .radius = radius,
                        .tile_size = 4,
                        .slices = 2,
                        .steps = 12,
                        .estimator = ALCOVE_ESTIMATOR_CONNECTED,
                        .weighting = ALCOVE_WEIGHTING_COSINE,
                        .thickness = 0.3f,
                        .thickness_limit = ALCOVE_THICKNESS_LIMIT_RADIUS,
                        .hidden_occlusion = 0.286f,
                        .depth_layers = 1,
                        .history_frames = 32,
                        .static_noise = 0,
                        .half_resolution = 0,
                        .specular = ALCOVE_SPECULAR_SLICES,
                        .roughness = 0.5f,
                        .roughness_channel = 0,
                        .precision = ALCOVE_PRECISION_UNORM8,
                        .power = 1.0f,
                        .intensity = 1.0f};
  switch (number_of(quality)) {
    case ALCOVE_QUALITY_CONSOLE:
      preset.tile_size = 8;
      preset.half_resolution = 1;
      [[fallthrough]];
    case ALCOVE_QUALITY_LOW:
      preset.slices = 1;
      preset.steps = preset.half_resolution != 0 ? 10 : 8;
      break;
    case ALCOVE_QUALITY_MEDIUM:
      break;
    case ALCOVE_QUALITY_ULTRA:
      preset.steps = 10;
      preset.depth_layers = 2;
      [[fallthrough]];
    case ALCOVE_QUALITY_HIGH:
      preset.tile_size = 2;
      break;
    case ALCOVE_QUALITY_HEIGHT_FIELD:
      preset.tile_size = 1;
      preset.slices = 32;
      preset.steps = 64;
      preset.history_frames = 0;
      preset.precision = ALCOVE_PRECISION_FLOAT32;
      preset.estimator = ALCOVE_ESTIMATOR_HORIZONS;
      break;
    default:
      return ALCOVE_ERROR_INVALID_INPUT;
  }
  return guarded([&] { return check(&preset).map([&] { *settings = preset; }); });
}

size_t alcovePrintSettings(const AlcoveSettings* settings, char* text, size_t size) {
  copy_text("", text, size);
  std::size_t length = 0;
  guarded([&]() -> Result {
    return check(settings).map([&] {
      std::string lines;
      for (const SettingInfo& info : setting_table())
        lines += std::string(info.name) + " = " + setting_text(*settings, info) + "\n";
      length = copy_text(lines, text, size);
    });
  });
  return length;
}

AlcoveResult alcoveReadSettings(const char* text, size_t length, AlcoveSettings* settings,
                                char* message) {
  return guarded(message, [&] { return read(text, length, settings); });
}

uint32_t alcoveGetConvergedFrames(const AlcoveSettings* settings) {
  std::uint32_t frames = 0;
  guarded([&]() -> Result {
    return check(settings).map([&] {
      frames = settings->history_frames > 0 ? 128 : settings->static_noise != 0 ? 1 : 0;
    });
  });
  return frames;
}
