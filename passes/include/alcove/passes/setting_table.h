// The settings as a table: name, description and range of each. validate(), the C interface,
// `--set` and the help of `alcove`, report.json and the window's sliders all read it.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "alcove/passes/setting_names.h"
#include "alcove/passes/settings.h"

namespace alcove::passes {

// The numbers that a setting may have. Numbers that are not finite are never allowed.
struct SettingRange {
  float minimum = 0.0f;
  float maximum = std::numeric_limits<float>::infinity();  // infinity: no maximum
  bool above_minimum = false;                              // the minimum itself is excluded
  bool power_of_two = false;

  [[nodiscard]] bool contains(float value) const;
  [[nodiscard]] bool contains(std::uint32_t value) const;
  // Completes "it must be ...": "1 to 64", "above 0", "1, 2 or 4".
  [[nodiscard]] std::string text() const;
};

enum class SettingGroup : std::uint8_t {
  main,
  output,   // what is computed; in C, giving an image asks for it
  surface,  // what materials are like where there is no texture of it
  advanced,
};

struct SettingInfo {
  const char* name;
  const char* help;  // one or more sentences
  SettingGroup group = SettingGroup::main;
  SettingRange range = {};   // of a number
  SettingRange slider = {};  // what a slider offers of a range without a maximum
  // Whether the setting has an effect beside the others; null: always.
  bool (*matters)(const OcclusionSettings& settings) = nullptr;
};

// Calls `visit(info, field)` for every setting but the outputs `visibility` and `linear_depth`. The
// main settings come first, the advanced ones last.
template <typename Settings, typename Visit>
void for_each_setting(Settings& settings, const Visit& visit) {
  using S = const OcclusionSettings&;
  constexpr auto has_thickness = [](S s) { return passes::has_thickness(s.advanced.estimator); };
  visit(SettingInfo{.name = "radius",
                    .help = "Distance in scene units beyond which occluders do not count.",
                    .range = {.above_minimum = true},
                    .slider = {.minimum = 0.05f, .maximum = 10.0f}},
        settings.radius);
  visit(SettingInfo{.name = "tile_size",
                    .help = "Width of a tile in pixels. One pixel per tile is traced in a frame.",
                    .range = {.minimum = 1, .maximum = 8, .power_of_two = true}},
        settings.tile_size);
  visit(SettingInfo{.name = "slices",
                    .help = "Slices per traced pixel and frame. More slices reduce noise.",
                    .range = {.minimum = 1, .maximum = 64}},
        settings.slices);
  visit(SettingInfo{.name = "steps",
                    .help = "Depth samples per half-slice. More find thinner occluders.",
                    .range = {.minimum = 2, .maximum = 64}},
        settings.steps);
  visit(SettingInfo{.name = "thickness",
                    .help = "Thickness of occluders, as a fraction of the radius or in "
                            "thickness_unit.",
                    .slider = {.maximum = 1.0f},
                    .matters = has_thickness},
        settings.thickness);
  visit(SettingInfo{.name = "hidden_occlusion",
                    .help = "Fraction of the volume hidden behind occluders that is treated as "
                            "solid.",
                    .range = {.maximum = 1.0f},
                    .matters = has_thickness},
        settings.hidden_occlusion);
  visit(SettingInfo{.name = "depth_layers",
                    .help = "Depth layers that are searched. The second holds the nearest front "
                            "faces behind the first.",
                    .range = {.minimum = 1, .maximum = 2},
                    .matters = has_thickness},
        settings.depth_layers);
  visit(SettingInfo{.name = "history_frames",
                    .help = "The most frames that the history averages. 0 keeps no history.",
                    .range = {.maximum = 127}},
        settings.history_frames);
  visit(SettingInfo{.name = "half_resolution",
                    .help = "Filters and accumulates at half resolution, then upsamples. For tiles "
                            "of at least 2 pixels.",
                    .matters = [](S s) { return s.tile_size > 1; }},
        settings.half_resolution);
  visit(SettingInfo{.name = "specular",
                    .help = "How specular occlusion is computed: from the slices (most exact), or "
                            "from visibility and the bent normal by a table or by cones."},
        settings.specular);
  visit(SettingInfo{.name = "precision", .help = "Format of outputs and intermediate results."},
        settings.precision);
  visit(SettingInfo{.name = "power",
                    .help = "Exponent of the visibility that is written. 1 changes nothing.",
                    .range = {.maximum = 16.0f, .above_minimum = true}},
        settings.power);
  visit(SettingInfo{.name = "intensity",
                    .help = "Factor of the occlusion that is written. 1 changes nothing.",
                    .range = {.maximum = 16.0f}},
        settings.intensity);
  visit(SettingInfo{.name = "bent_normal",
                    .help = "Also computes the mean visible direction.",
                    .group = SettingGroup::output},
        settings.bent_normal);
  visit(SettingInfo{.name = "roughness",
                    .help = "Perceptual roughness of pixels without a roughness texture.",
                    .group = SettingGroup::surface,
                    .range = {.maximum = 1.0f}},
        settings.roughness);
  visit(SettingInfo{.name = "roughness_channel",
                    .help = "Channel of the roughness texture.",
                    .group = SettingGroup::surface,
                    .range = {.maximum = 3}},
        settings.roughness_channel);

  constexpr SettingGroup advanced = SettingGroup::advanced;
  visit(SettingInfo{.name = "estimator",
                    .help = "What is behind an occluder's front: everything (horizons, and the "
                            "heuristic that lowers them), or a thickness for each sample (bitmask) "
                            "or for each connected segment (connected).",
                    .group = advanced},
        settings.advanced.estimator);
  visit(SettingInfo{.name = "weighting",
                    .help = "Weight of a visible direction in visibility: the cosine of its angle "
                            "to the normal, or 1.",
                    .group = advanced},
        settings.advanced.weighting);
  visit(SettingInfo{.name = "thickness_unit",
                    .help = "Unit of the thickness: the radius, the distance from the eye, or the "
                            "scene's back faces in its place.",
                    .group = advanced,
                    .matters = has_thickness},
        settings.advanced.thickness_unit);
  visit(SettingInfo{.name = "blend",
                    .help = "How far a sample below the horizon lowers it: 0 not at all, 1 down to "
                            "the sample (heuristic only).",
                    .group = advanced,
                    .range = {.maximum = 1.0f},
                    .matters = [](S s) { return s.advanced.estimator == Estimator::heuristic; }},
        settings.advanced.blend);
  visit(SettingInfo{.name = "falloff",
                    .help = "Last fraction of the radius, over which occluders fade (horizons and "
                            "heuristic).",
                    .group = advanced,
                    .range = {.maximum = 1.0f},
                    .matters = [](S s) { return !passes::has_thickness(s.advanced.estimator); }},
        settings.advanced.falloff);
  visit(SettingInfo{.name = "pattern",
                    .help = "How slice directions vary over pixels and frames.",
                    .group = advanced},
        settings.advanced.pattern);
  visit(SettingInfo{.name = "filter_radius",
                    .help = "Filter radius in tiles for pixels with fewer than two frames of "
                            "history. 0 turns the filter off.",
                    .group = advanced,
                    .range = {.maximum = 3}},
        settings.advanced.filter_radius);
  visit(SettingInfo{.name = "filter_tolerance_px",
                    .help = "Distance from the pixel's tangent plane, in pixels, at which a "
                            "neighbour's weight falls to 0.25. It holds for one slice and no "
                            "history, and shrinks with more samples.",
                    .group = advanced,
                    .range = {.above_minimum = true},
                    .slider = {.minimum = 0.1f, .maximum = 8.0f},
                    .matters = [](S s) { return s.advanced.filter_radius > 0; }},
        settings.advanced.filter_tolerance_px);
  visit(SettingInfo{.name = "clamp_width",
                    .help = "Standard deviations around the mean of the frame's neighbourhood to "
                            "which the history is clamped. 0 turns clamping off.",
                    .group = advanced,
                    .slider = {.maximum = 8.0f},
                    .matters = [](S s) { return s.history_frames > 0; }},
        settings.advanced.clamp_width);
  visit(
      SettingInfo{
          .name = "snap_to_texels", .help = "Snaps samples to texel centres.", .group = advanced},
      settings.advanced.snap_to_texels);
  visit(SettingInfo{.name = "extrapolation",
                    .help = "Extrapolates surfaces beyond the image's border (connected).",
                    .group = advanced},
        settings.advanced.extrapolation);
  visit(SettingInfo{.name = "unobserved",
                    .help = "Leaves directions that the depth buffer does not show (behind a "
                            "foreground, or beyond the image's border) partly out of the "
                            "average. If off, they count as open (connected only).",
                    .group = advanced},
        settings.advanced.unobserved);
  visit(
      SettingInfo{.name = "grouping",
                  .help = "Tiles that a workgroup traces: 8x8 adjacent ones, or every fourth in x "
                          "and y. It changes the cost and not the image.",
                  .group = advanced},
      settings.advanced.grouping);
}

}  // namespace alcove::passes
