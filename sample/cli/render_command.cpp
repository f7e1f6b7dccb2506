#include "cli/render_command.h"

#include <fmt/format.h>
#include <cstdlib>
#include <utility>

#include "alcove/passes/setting_table.h"
#include "cli/settings.h"

namespace alcove::sample {
namespace {

std::string vector_text(const glm::vec3& v) { return fmt::format("{},{},{}", v.x, v.y, v.z); }

// The shortest text that is parsed as the same angle.
std::string degrees_text(float radians) {
  std::string text;
  for (int digits = 3; digits <= 9; ++digits) {
    text = fmt::format("{:.{}g}", glm::degrees(radians), digits);
    if (glm::radians(std::strtof(text.c_str(), nullptr)) == radians) break;
  }
  return text;
}

// Returns the settings that differ from those of a quality, in the form of --set.
std::vector<std::string> changes(AlcoveQuality quality, const OcclusionSettings& settings) {
  const OcclusionSettings preset(quality, settings.radius);
  std::vector<std::string> result;
  for (const passes::SettingInfo& info : passes::setting_table()) {
    const std::string now = setting_text(settings, info);
    if (now != setting_text(preset, info) && !info.of_material)
      result.push_back(fmt::format("{}={}", info.name, now));
  }
  if (settings.bent_normal) result.emplace_back("bent_normal=true");
  return result;
}

void append_camera(const Camera& camera, std::vector<std::string>& to) {
  const auto position = [&](const glm::vec3& p) {
    return fmt::format("{},{},{}", coordinate_text(p.x, camera.origin.x),
                       coordinate_text(p.y, camera.origin.y),
                       coordinate_text(p.z, camera.origin.z));
  };
  to.insert(to.end(), {"--eye", position(camera.eye_ws), "--target", position(camera.target_ws),
                       "--up", vector_text(camera.up_ws)});
  if (camera.orthographic)
    to.insert(to.end(), {"--ortho-height", fmt::to_string(camera.ortho_height)});
  else
    to.insert(to.end(), {"--fov-y", degrees_text(camera.fov_y)});
  to.insert(to.end(), {"--near", fmt::to_string(camera.near_plane), "--far",
                       fmt::to_string(camera.far_plane)});
  if (camera.reversed_z == camera.orthographic)  // not the default
    to.emplace_back(camera.reversed_z ? "--reversed-z" : "--standard-z");
}

// Returns the options that give these settings except their radius: --quality with the quality that
// needs the fewest changes, and --set for each change.
std::vector<std::string> setting_arguments(const OcclusionSettings& settings) {
  AlcoveQuality closest = ALCOVE_QUALITY_CONSOLE;
  std::vector<std::string> fewest = changes(closest, settings);
  for (std::size_t i = 1; i < passes::kQualityNames.size(); ++i) {
    std::vector<std::string> more = changes(static_cast<AlcoveQuality>(i), settings);
    if (more.size() < fewest.size()) {
      closest = static_cast<AlcoveQuality>(i);
      fewest = std::move(more);
    }
  }
  std::vector<std::string> arguments{"--quality", std::string(passes::kQualityNames.at(closest))};
  for (const std::string& change : fewest) arguments.insert(arguments.end(), {"--set", change});
  return arguments;
}

}  // namespace

std::vector<std::string> render_arguments(const Options& options, const Shot& shot) {
  std::vector<std::string> arguments{"alcove", "render"};
  if (!options.scene.empty()) arguments.push_back(options.scene);
  if (options.materials.cut_blends) arguments.emplace_back("--cut-blends");
  if (options.materials.both_sides) arguments.emplace_back("--both-sides");
  append_camera(shot.camera, arguments);
  arguments.insert(arguments.end(), {"--size", fmt::format("{}x{}", shot.width, shot.height)});
  const auto settings = setting_arguments(shot.settings);
  arguments.insert(arguments.end(), settings.begin(), settings.end());
  arguments.insert(arguments.end(), {"--radius", fmt::to_string(shot.settings.radius)});
  if (shot.guard_band > 0.0)
    arguments.insert(arguments.end(), {"--guard-band", fmt::to_string(shot.guard_band)});
  if (shot.normals != NormalSource::shading)
    arguments.insert(arguments.end(), {"--normals", std::string(name_of(shot.normals))});
  if (shot.roughness)
    arguments.insert(arguments.end(), {"--roughness", fmt::to_string(*shot.roughness)});
  if (!options.environment.empty())
    arguments.insert(arguments.end(), {"--environment", options.environment.string()});
  const std::uint32_t frames = shot.frames > 0 ? shot.frames : shot.settings.history_frames;
  if (frames > 1) arguments.insert(arguments.end(), {"--frames", fmt::to_string(frames)});
  if (options.device >= 0)
    arguments.insert(arguments.end(), {"--device", fmt::to_string(options.device)});
  return arguments;
}

std::string choice_text(const Choice& choice) {
  return shell_line(setting_arguments(choice.settings)) +
         (choice.guard_band > 0.0 ? fmt::format(" --guard-band {:g}", choice.guard_band) : "");
}

std::string coordinate_text(float value, double origin) {
  if (origin == 0.0) return fmt::to_string(value);
  std::string text;
  for (int digits = 6; digits <= 17; ++digits) {
    text = fmt::format("{:.{}g}", origin + static_cast<double>(value), digits);
    if (static_cast<float>(std::strtod(text.c_str(), nullptr) - origin) == value) break;
  }
  return text;
}

std::string shell_line(const std::vector<std::string>& arguments) {
  constexpr const char* kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=,:+";
  std::string line;
  for (const std::string& argument : arguments) {
    line += line.empty() ? "" : " ";
    if (!argument.empty() && argument.find_first_not_of(kPlain) == std::string::npos) {
      line += argument;
      continue;
    }
    line += '\'';
    for (const char c : argument) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

}  // namespace alcove::sample
