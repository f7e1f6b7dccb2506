// The settings of the occlusion passes. A default-constructed OcclusionSettings is the preset
// `medium`. Every pass reads the same struct.
#pragma once

#include <cstdint>

#include "alcove/passes/advanced.h"
#include "alcove/passes/frame.h"

namespace alcove::passes {

// Presets for quality_settings(). All but `reference` keep a history of 32 frames. The depth
// fetches are those of a pixel and frame.
enum class Quality : std::uint8_t {
  // 1 slice with 8 steps per half-slice, one pixel in 8x8 traced, filter and history at half
  // resolution: a quarter of a fetch. For half a millisecond on a console of the generation of the
  // paper.
  console,
  low,     // 1 slice with 8 steps per half-slice, one pixel in 4x4 traced: 1 fetch.
  medium,  // 1 slice with 10 steps, one pixel in 2x2: 5 fetches. The preset to begin with.
  high,    // 2 slices with 16 steps, one pixel in 2x2: 16 fetches.
  // 32 slices with 64 steps, every pixel: 4096 fetches. The paper's horizons, without filter and
  // history, in 32-bit floats: a static image to compare with.
  reference,
};

// How specular occlusion is computed: the visible fraction of each surface's GGX lobe.
enum class Specular : std::uint8_t {
  none,    // Not at all.
  slices,  // Integrates the lobe over the slices that visibility is computed from: the most exact.
  // The next two use visibility and the bent normal, which are then computed too: [Jimenez 2016],
  // section 6 (shaders/maths/gtso.h).
  table,  // The lobe within the visibility cone, from a table of 54 KiB.
  cone,   // The exact intersection of the visibility cone with a cone that stands for the lobe.
};

struct OcclusionSettings {
  // Occluders beyond this distance do not count. Scene units, above 0. A twentieth to a fifth of a
  // room's height is usual.
  float radius = 0.5f;
  // Width of a tile in pixels: 1, 2, 4 or 8. One pixel per tile is traced in a frame; the
  // interleave offset moves it from frame to frame.
  std::uint32_t tile_size = 2;
  // Slices per traced pixel and frame, 1 to 64. More slices reduce noise.
  std::uint32_t slices = 1;
  // Depth samples per half-slice, 2 to 64. More find thinner occluders. A traced pixel costs
  // 2 * slices * steps depth fetches.
  std::uint32_t steps = 10;
  // Thickness of occluders as a fraction of the radius (or in AdvancedSettings::thickness_unit), at
  // least 0. At its leading edge an occluder is at most as thick as its visible width, so that
  // blades, bars and leaves are thin.
  float thickness = 0.15f;
  // Fraction of the volume hidden behind occluders that is treated as solid, [0,1], in the mean. It
  // is larger behind occluders that are wide on the image (hidden_occlusion_behind() in
  // shaders/maths/visibility_bitmask.h). Raising it darkens corners behind foregrounds.
  float hidden_occlusion = 0.33f;
  // Depth layers that are searched: 1, or 2 with OcclusionInputs::second_depth_ndc.
  std::uint32_t depth_layers = 1;
  // Frames that are averaged, 0 to 127; from 16 static frames on, 127. 0 keeps no history and
  // allocates none, for engines with a temporal filter of their own.
  std::uint32_t history_frames = 32;
  // Filters and accumulates texels of 2x2 pixels, and makes pixels from them by edge-aware
  // upsampling: less time, less memory for the history, and a larger error (passes/README.md
  // has figures). Needs a tile_size of at least 2.
  bool half_resolution = false;

  // Outputs. One that is off costs neither a pass nor memory.
  bool visibility = true;
  bool bent_normal = false;   // The mean visible direction.
  bool linear_depth = false;  // OcclusionOutputs::linear_depth, for lighting.
  Specular specular = Specular::none;

  // Perceptual roughness of every pixel, [0,1], where there is no roughness texture.
  float roughness = 0.5f;
  std::uint32_t roughness_channel = 0;  // Channel of the roughness texture, 0 to 3.
  // Format of outputs and of intermediate results that the caller gives no texture for.
  Precision precision = Precision::unorm8;
  // The visibility that is written is 1 - intensity * (1 - visibility^power), clamped to [0,1].
  // Above 0 to 16, and 0 to 16. 1 and 1 change nothing and cost nothing. Multi-bounce, and the
  // specular models `table` and `cone`, read the visibility that is written.
  float power = 1.0f;
  float intensity = 1.0f;

  AdvancedSettings advanced;

  friend bool operator==(const OcclusionSettings&, const OcclusionSettings&) = default;
};

// The settings of a preset at a radius in scene units.
[[nodiscard]] OcclusionSettings quality_settings(Quality quality, float radius);

// Checks every setting against its range (setting_table.h), and the combinations. The error is one
// sentence that names the setting, its value and what it may be. Every pass calls it.
[[nodiscard]] tl::expected<void, Error> validate(const OcclusionSettings& settings);

// Whether OcclusionInputs::back_depth_ndc is read. If not, an engine need not draw back faces.
[[nodiscard]] constexpr bool needs_back_depth(const OcclusionSettings& settings) {
  return has_thickness(settings.advanced.estimator) &&
         settings.advanced.thickness_unit == ThicknessUnit::back_faces;
}

// Whether OcclusionInputs::second_depth_ndc is read.
[[nodiscard]] constexpr bool needs_second_depth(const OcclusionSettings& settings) {
  return has_thickness(settings.advanced.estimator) && settings.depth_layers > 1;
}

// Whether specular occlusion is computed from visibility and the bent normal, by a pass of its own.
[[nodiscard]] constexpr bool specular_reads_bent_normal(const OcclusionSettings& settings) {
  return settings.specular == Specular::table || settings.specular == Specular::cone;
}

// Whether bent normals are computed, for output or for specular occlusion.
[[nodiscard]] constexpr bool needs_bent_normal(const OcclusionSettings& settings) {
  return settings.bent_normal || specular_reads_bent_normal(settings);
}

// Whether visibility is written, as an output or for specular occlusion.
[[nodiscard]] constexpr bool needs_visibility(const OcclusionSettings& settings) {
  return settings.visibility || specular_reads_bent_normal(settings);
}

}  // namespace alcove::passes
