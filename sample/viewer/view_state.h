#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "gpu/occlusion.h"
#include "scene/camera.h"

namespace alcove::sample {

// The images of a frame that the window can show.
enum class Picture : std::uint8_t {
  visibility,
  lit,
  multi_bounce,
  bent_normal,
  specular_occlusion,
  normals,
  depth,
  albedo,
  motion,
};
inline constexpr std::array<std::string_view, 9> kPictureNames{
    "visibility", "lit",   "multi-bounce", "bent normal", "specular occlusion",
    "normals",    "depth", "albedo",       "motion"};

// The settings that the right part of the window shows for comparison, if any.
enum class Comparison : std::uint8_t { none, horizons, height_field, saved };
inline constexpr std::array<std::string_view, 4> kComparisonNames{
    "nothing", "estimator horizons", "preset height_field", "kept settings"};

// Everything that the user can choose in the window.
struct ViewState {
  Camera camera;
  OcclusionSettings settings;
  std::optional<float> roughness;  // of every surface; null: the roughness of its material
  Picture picture = Picture::lit;
  Comparison comparison = Comparison::none;
  OcclusionSettings saved;   // the settings of Comparison::saved
  bool fits_budget = false;  // whether slices and steps follow the measured times
  float target_ms = 2.0f;    // of the occlusion passes, if fits_budget
  double guard_band = 0.0;   // percent of the window's height
  float split = 0.5f;        // position of the right part's left edge, 0..1 of the width
};

// Returns the settings of the right part, or null without a comparison.
[[nodiscard]] inline std::optional<OcclusionSettings> compared_settings(const ViewState& state) {
  OcclusionSettings settings = state.settings;
  switch (state.comparison) {
    case Comparison::horizons:
      settings.estimator = ALCOVE_ESTIMATOR_HORIZONS;
      return settings;
    case Comparison::height_field:
      settings = OcclusionSettings(ALCOVE_QUALITY_HEIGHT_FIELD, settings.radius);
      settings.specular = state.settings.specular;
      return settings;
    case Comparison::saved:
      return state.saved;
    default:
      return std::nullopt;
  }
}

}  // namespace alcove::sample
