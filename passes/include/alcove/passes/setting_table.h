// The table of settings: the name, the description and the range of each. It is used by validate(),
// the C interface, the option `--set` and the help of the program `alcove`, report.json, and the
// sliders of the window.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "alcove/passes/setting_names.h"
#include "alcove/passes/settings.h"

namespace alcove::passes {

// The range of values of a numeric setting. Infinite values and NaN are never allowed.
struct SettingRange {
  float minimum = 0.0f;
  float maximum = std::numeric_limits<float>::infinity();  // infinity: no maximum
  bool above_minimum = false;                              // the minimum itself is excluded
  bool power_of_two = false;

  [[nodiscard]] bool contains(float value) const;
  [[nodiscard]] bool contains(std::uint32_t value) const;
  // Returns a text that completes the words "it must be", for example "1 to 64", "above 0" or "1, 2
  // or 4".
  [[nodiscard]] std::string text() const;
};

enum class SettingGroup : std::uint8_t {
  main,
  output,   // an output to compute; in C, an output is selected by giving an image for it
  surface,  // a material parameter that is used if there is no texture for it
};

struct SettingInfo {
  const char* name;
  const char* help;  // one or more sentences
  SettingGroup group = SettingGroup::main;
  SettingRange range = {};   // of a number
  SettingRange slider = {};  // range of a slider, if `range` has no maximum
  // Returns whether the setting has an effect with these other settings. Null: it always has one.
  bool (*matters)(const OcclusionSettings& settings) = nullptr;
};

// Calls `visit(info, field)` for every setting except the outputs `visibility` and `linear_depth`.
template <typename Settings, typename Visit>
void for_each_setting(Settings& settings, const Visit& visit) {
  using S = const OcclusionSettings&;
  constexpr auto has_thickness = [](S s) { return passes::has_thickness(s); };
  visit(
      SettingInfo{
          .name = "radius",
          .help = "Distance in scene units beyond which occluders do not count. A twentieth to a "
                  "fifth of a room's height is usual.",
          .range = {.above_minimum = true},
          .slider = {.minimum = 0.05f, .maximum = 10.0f}},
      settings.radius);
  visit(
      SettingInfo{
          .name = "tile_size",
          .help = "Width of a tile in pixels. One pixel per tile is traced in each frame, and the "
                  "filter and the history fill the others. 1 traces every pixel.",
          .range = {.minimum = 1, .maximum = 8, .power_of_two = true}},
      settings.tile_size);
  visit(SettingInfo{.name = "slices",
                    .help =
                        "Slices (planes through the view direction) that are searched per traced "
                        "pixel and frame. More slices reduce noise; the time grows in proportion.",
                    .range = {.minimum = 1, .maximum = 64}},
        settings.slices);
  visit(SettingInfo{.name = "steps",
                    .help = "Depth samples in each of the two directions of a slice. More samples "
                            "find thinner occluders.",
                    .range = {.minimum = 2, .maximum = 64}},
        settings.steps);
  visit(SettingInfo{.name = "estimator",
                    .help = "Assumption about the thickness of occluders: infinite (horizons), or "
                            "finite and without gaps between the samples of one surface "
                            "(connected)."},
        settings.estimator);
  visit(SettingInfo{.name = "weighting",
                    .help = "For the estimator horizons: weight of a direction in visibility, the "
                            "cosine of its angle to the normal, or 1 (uniform).",
                    .matters = [](S s) { return s.estimator == Estimator::horizons; }},
        settings.weighting);
  visit(SettingInfo{.name = "thickness",
                    .help = "Largest thickness of occluders as a fraction of the radius. Larger "
                            "values darken.",
                    .slider = {.maximum = 1.0f},
                    .matters = has_thickness},
        settings.thickness);
  visit(
      SettingInfo{.name = "thickness_unit",
                  .help = "What limits the thickness of occluders: the setting thickness (radius), "
                          "or the back face behind them in a second depth buffer and, where there "
                          "is none, the setting thickness (back_faces).",
                  .matters = has_thickness},
      settings.thickness_unit);
  visit(SettingInfo{.name = "hidden_occlusion",
                    .help =
                        "Average fraction of the volume hidden behind occluders that is treated as "
                        "solid. Raising it darkens corners behind foregrounds.",
                    .range = {.maximum = 1.0f},
                    .matters = has_thickness},
        settings.hidden_occlusion);
  visit(SettingInfo{.name = "depth_layers",
                    .help = "Number of depth buffers that are searched for occluders. The second "
                            "one holds the nearest front faces that the first one hides.",
                    .range = {.minimum = 1, .maximum = 2},
                    .matters = has_thickness},
        settings.depth_layers);
  visit(
      SettingInfo{.name = "history_frames",
                  .help =
                      "Largest number of frames that the history averages while the image changes. "
                      "After 16 frames without a change the limit is 127. 0 turns the history off.",
                  .range = {.maximum = 127}},
      settings.history_frames);
  visit(SettingInfo{.name = "static_noise",
                    .help = "Gives every frame the same noise, for images that no temporal filter "
                            "follows. Without it, noise changes from frame to frame. It has an "
                            "effect with a history_frames of 0.",
                    .matters = [](S s) { return s.history_frames == 0; }},
        settings.static_noise);
  visit(SettingInfo{.name = "half_resolution",
                    .help = "Filters and accumulates at half of the image's width and height, then "
                            "upsamples: less time, larger error. It needs a tile_size above 1.",
                    .matters = [](S s) { return s.tile_size > 1; }},
        settings.half_resolution);
  visit(SettingInfo{.name = "specular",
                    .help = "Method of specular occlusion: none, integration over the slices "
                            "(slices, smallest error), or from visibility and the bent normal with "
                            "a table (table)."},
        settings.specular);
  visit(
      SettingInfo{
          .name = "precision",
          .help =
              "Format of intermediate results, and of outputs for which the caller gives no "
              "texture: 8-bit UNORM (unorm8), 16-bit floats (float16) or 32-bit floats (float32)."},
      settings.precision);
  visit(SettingInfo{.name = "power",
                    .help = "Exponent that is applied to visibility before it is written. Above 1 "
                            "darkens; 1 changes nothing.",
                    .range = {.maximum = 16.0f, .above_minimum = true}},
        settings.power);
  visit(SettingInfo{.name = "intensity",
                    .help = "Factor that is applied to occlusion (1 - visibility) before it is "
                            "written. Above 1 darkens; 1 changes nothing.",
                    .range = {.maximum = 16.0f}},
        settings.intensity);
  visit(
      SettingInfo{.name = "bent_normal",
                  .help = "Also writes bent normals: the mean unoccluded direction of each pixel.",
                  .group = SettingGroup::output},
      settings.bent_normal);
  visit(SettingInfo{.name = "roughness",
                    .help = "Perceptual roughness of pixels without a roughness texture.",
                    .group = SettingGroup::surface,
                    .range = {.maximum = 1.0f}},
        settings.roughness);
  visit(
      SettingInfo{
          .name = "roughness_channel",
          .help = "Channel of the roughness texture that holds the roughness: 0 red to 3 alpha.",
          .group = SettingGroup::surface,
          .range = {.maximum = 3}},
      settings.roughness_channel);
}

}  // namespace alcove::passes
