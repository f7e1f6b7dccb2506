// The settings of the occlusion passes. A default-constructed OcclusionSettings is the preset
// `medium`. Every pass reads the same struct.
#pragma once

#include <cstdint>

#include "alcove/passes/frame.h"

namespace alcove::passes {

// Presets for quality_settings(). All except `reference` keep a history of 32 frames. The comment
// of each preset says how many depth samples are fetched per pixel of the image and frame.
enum class Quality : std::uint8_t {
  // 1 slice of 8 steps per half-slice, which is 16 depth fetches per traced pixel. Traces one pixel
  // of each tile of 8x8, which is 0.25 fetches per pixel of the image. The filter and the history
  // have half resolution. For consoles of about the year 2013 (PS4), as in [Jimenez 2016].
  console,
  low,     // 1 slice of 8 steps per half-slice; traces one pixel in 4x4: 1 fetch.
  medium,  // 2 slices of 12 steps; one pixel in 4x4: 3 fetches. The default.
  high,    // 2 slices of 12 steps; one pixel in 2x2: 12 fetches.
  // 2 slices of 10 steps in two depth layers; one pixel in 2x2: 20 fetches. It needs
  // OcclusionInputs::second_depth_ndc. Without that texture the passes return an error; set
  // depth_layers to 1, or choose `high`.
  ultra,
  // 32 slices of 64 steps per half-slice; traces every pixel: 4096 fetches. For comparisons with a
  // static image: without filter and history, in 32-bit floats, and with the infinitely thick
  // occluders of [Jimenez 2016].
  reference,
};

// How the thickness of occluders is estimated: AlcoveEstimator (alcove_settings.h).
enum class Estimator : std::uint8_t { horizons, connected };

// How visibility weights directions: AlcoveWeighting (alcove_settings.h).
enum class Weighting : std::uint8_t { cosine, uniform };

// The unit of OcclusionSettings::thickness: AlcoveThicknessUnit (alcove_settings.h). With
// `back_faces`, an occluder ends at the nearest back face on its view ray
// (OcclusionInputs::back_depth_ndc). For a closed solid, that is the point where the ray leaves it,
// unless another solid stands inside it. A card in front of a solid is assumed to extend to the
// solid's back, because two depths cannot distinguish this case.
enum class ThicknessUnit : std::uint8_t { radius, back_faces };

// How specular occlusion is computed: AlcoveSpecular (alcove_settings.h). `table` is that of
// [Jimenez 2016], section 6 (shaders/maths/gtso_table.h).
enum class Specular : std::uint8_t { none, slices, table };

// AlcoveSettings (alcove_settings.h) describes the fields, apart from those for outputs.
struct OcclusionSettings {
  float radius = 0.5f;
  std::uint32_t tile_size = 4;
  std::uint32_t slices = 2;
  std::uint32_t steps = 12;
  Estimator estimator = Estimator::connected;
  Weighting weighting = Weighting::cosine;
  float thickness = 0.3f;
  ThicknessUnit thickness_unit = ThicknessUnit::radius;
  float hidden_occlusion = 0.286f;
  std::uint32_t depth_layers = 1;
  std::uint32_t history_frames = 32;
  bool static_noise = false;
  bool half_resolution = false;

  // Outputs. An output that is off needs no pass and no memory.
  bool visibility = true;
  bool bent_normal = false;   // The mean unoccluded direction.
  bool linear_depth = false;  // OcclusionOutputs::linear_depth, for lighting.
  Specular specular = Specular::none;

  float roughness = 0.5f;
  std::uint32_t roughness_channel = 0;
  // Also the format of outputs for which the caller gives no texture.
  Precision precision = Precision::unorm8;
  float power = 1.0f;
  float intensity = 1.0f;

  friend bool operator==(const OcclusionSettings&, const OcclusionSettings&) = default;
};

// Returns the settings of a preset with a radius in scene units.
[[nodiscard]] OcclusionSettings quality_settings(Quality quality, float radius);

// Checks every setting against its range (setting_table.h), and settings that depend on each other.
// The error is a sentence with the setting's name, its value and the allowed values. Every pass
// calls it.
[[nodiscard]] tl::expected<void, Error> validate(const OcclusionSettings& settings);

// Returns whether occluders have a finite thickness, so that thickness, hidden_occlusion and
// depth_layers have an effect.
[[nodiscard]] constexpr bool has_thickness(const OcclusionSettings& settings) {
  return settings.estimator == Estimator::connected;
}

// Returns the radius of the spatial filter in tiles, for pixels with fewer than two frames of
// history. Pixels with more history use a radius of 1. There is no filter (0) if every pixel is
// traced with 8 slices or more, whose noise is smaller than the detail that a filter would blur.
[[nodiscard]] constexpr std::uint32_t filter_radius(const OcclusionSettings& settings) {
  return settings.tile_size == 1 && settings.slices >= 8 ? 0 : 2;
}

// Returns whether OcclusionInputs::back_depth_ndc is read. If not, an engine need not draw back
// faces.
[[nodiscard]] constexpr bool needs_back_depth(const OcclusionSettings& settings) {
  return has_thickness(settings) && settings.thickness_unit == ThicknessUnit::back_faces;
}

// Returns whether OcclusionInputs::second_depth_ndc is read.
[[nodiscard]] constexpr bool needs_second_depth(const OcclusionSettings& settings) {
  return has_thickness(settings) && settings.depth_layers > 1;
}

// Returns whether all frames have the same noise, so that Frame::index is not read.
[[nodiscard]] constexpr bool has_static_noise(const OcclusionSettings& settings) {
  return settings.static_noise && settings.history_frames == 0;
}

// Returns the number of frames of an unchanged image after which further frames no longer improve
// it: 128 with a history, which is then full, and 1 with static noise. It is 0, which stands for
// never, without a history if the noise changes from frame to frame.
[[nodiscard]] constexpr std::uint32_t converged_frames(const OcclusionSettings& settings) {
  return settings.history_frames > 0 ? 128 : settings.static_noise ? 1 : 0;
}

// Returns whether add_gtso() computes specular occlusion, from visibility and the bent normal.
[[nodiscard]] constexpr bool specular_reads_bent_normal(const OcclusionSettings& settings) {
  return settings.specular == Specular::table;
}

// Returns whether bent normals are computed, as an output or for specular occlusion.
[[nodiscard]] constexpr bool needs_bent_normal(const OcclusionSettings& settings) {
  return settings.bent_normal || specular_reads_bent_normal(settings);
}

// Returns whether visibility is written, as an output or for specular occlusion.
[[nodiscard]] constexpr bool needs_visibility(const OcclusionSettings& settings) {
  return settings.visibility || specular_reads_bent_normal(settings);
}

}  // namespace alcove::passes
