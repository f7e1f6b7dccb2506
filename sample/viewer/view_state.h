#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "alcove/passes/occlusion.h"
#include "scene/camera.h"

namespace alcove::sample {

// The images of a frame that the window can show.
enum class Picture : std::uint8_t {
  kVisibility,
  kLit,
  kMultiBounce,
  kBentNormal,
  kSpecularOcclusion,
  kNormals,
  kDepth,
  kAlbedo,
  kMotion,
};
inline constexpr std::array<std::string_view, 9> kPictureNames{
    "visibility", "lit",   "multi-bounce", "bent normal", "specular occlusion",
    "normals",    "depth", "albedo",       "motion"};

// The settings that the right part of the window shows for comparison, if any.
enum class Comparison : std::uint8_t { kNone, kHorizons, kReference, kKept };
inline constexpr std::array<std::string_view, 4> kComparisonNames{
    "nothing", "estimator horizons", "preset reference", "kept settings"};

// Everything that the user can choose in the window.
struct ViewState {
  Camera camera;
  passes::OcclusionSettings settings;
  std::optional<float> roughness;  // of every surface; null: the roughness of its material
  Picture picture = Picture::kVisibility;
  Comparison comparison = Comparison::kNone;
  passes::OcclusionSettings kept;  // the settings of Comparison::kKept
  float split = 0.5f;              // position of the right part's left edge, 0..1 of the width
};

// Returns the settings of the right part, or null without a comparison.
[[nodiscard]] inline std::optional<passes::OcclusionSettings> compared_settings(
    const ViewState& state) {
  passes::OcclusionSettings settings = state.settings;
  switch (state.comparison) {
    case Comparison::kHorizons:
      settings.advanced.estimator = passes::Estimator::horizons;
      return settings;
    case Comparison::kReference:
      settings = passes::quality_settings(passes::Quality::reference, settings.radius);
      settings.specular = state.settings.specular;
      return settings;
    case Comparison::kKept:
      return state.kept;
    default:
      return std::nullopt;
  }
}

}  // namespace alcove::sample
