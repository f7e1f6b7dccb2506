#pragma once

#include "alcove/passes/occlusion.h"
#include "alcove/passes/setting_names.h"

// The occlusion settings by the names that --set, report.json and the window know them by.
namespace alcove::sample {

// What people are told of a setting.
struct SettingInfo {
  const char* name;
  const char* help;
  // Of the window's slider for a number, the radius in parts of the scene's usual one; a whole
  // number lies within.
  float low = 0;
  float high = 0;
  // Whether it has an effect beside the others; null: always.
  bool (*matters)(const passes::OcclusionSettings& settings) = nullptr;
};

inline bool has_thickness(const passes::OcclusionSettings& settings) {
  return passes::has_thickness(settings.estimator);
}

// Calls `visit(info, field)` for every setting but roughness, which is the surfaces', and
// visibility, which the sample always draws.
template <typename Settings, typename Visit>
void for_each_setting(Settings& settings, const Visit& visit) {
  using Of = const passes::OcclusionSettings&;
  using Info = SettingInfo;
  visit(Info{"radius", "Occluders beyond it do not count; scene units.", 0.05f, 10.0f},
        settings.radius);
  visit(Info{"slices", "Directions searched in a pixel and frame.", 1, 64}, settings.slices);
  visit(Info{"steps", "Samples on each side of a slice.", 2, 64}, settings.steps);
  visit(Info{"estimator",
             "What stands behind an occluder's front: everything (horizons; heuristic lets them "
             "sink), or a thickness for each sample (bitmask) or for each connected surface "
             "(connected)."},
        settings.estimator);
  visit(Info{"weighting", "What a visible direction counts: by its cosine, or all alike."},
        settings.weighting);
  visit(Info{"thickness", "Of occluders, in its unit.", 0.0f, 1.0f, has_thickness},
        settings.thickness);
  visit(Info{"thickness_unit",
             "Parts of the radius or of the distance from the eye, or where the scene's back faces "
             "are.",
             0, 0, has_thickness},
        settings.thickness_unit);
  visit(Info{"hidden_occlusion", "How much of what is hidden behind occluders occludes too.", 0.0f,
             1.0f, has_thickness},
        settings.hidden_occlusion);
  visit(Info{"depth_layers", "Layers of depth that occlude: the first, and what it hides: 1 or 2.",
             1, 2, has_thickness},
        settings.depth_layers);
  visit(Info{"blend", "How far each lower sample pulls the horizon down (heuristic).", 0.0f, 1.0f,
             [](Of s) { return s.estimator == passes::Estimator::heuristic; }},
        settings.blend);
  visit(Info{"falloff", "Last part of the radius, over which occluders fade.", 0.0f, 1.0f,
             [](Of s) { return !has_thickness(s); }},
        settings.falloff);
  visit(
      Info{"tile_size", "One search a frame in a block of so many pixels a side: 1, 2 or 4.", 1, 4},
      settings.tile_size);
  visit(Info{"pattern", "How directions are spread over pixels and frames."}, settings.pattern);
  visit(
      Info{"snap_to_texels", "Samples lie where their texels do, else where they were asked for."},
      settings.parts.snap_to_texels);
  visit(Info{"extrapolation", "Surfaces that leave the image go on beyond its border."},
        settings.parts.extrapolation);
  visit(Info{"unobserved",
             "What foregrounds and the border hide is left out of visibility, else it is open."},
        settings.parts.unobserved);
  visit(Info{"grouping", "Searches that run together: neighbours, or those of one direction."},
        settings.parts.grouping);
  visit(Info{"filter_radius", "Searches on each side that a first frame looks at; 0: no filter.", 0,
             3},
        settings.filter_radius);
  visit(Info{"half_resolution",
             "Filters and accumulates at half resolution, then upsamples; for tiles of 2 or 4."},
        settings.half_resolution);
  visit(Info{"filter_tolerance_px",
             "How far from the tangent plane a neighbour counts in a first frame, in pixels.", 0.1f,
             8.0f, [](Of s) { return s.filter_radius > 0; }},
        settings.filter_tolerance_px);
  visit(Info{"history_frames", "Frames that are averaged; 0: no history.", 0, 127},
        settings.history_frames);
  visit(Info{"clamp_width", "Deviations that history is held to; 0: free.", 0.0f, 8.0f,
             [](Of s) { return s.history_frames > 0; }},
        settings.clamp_width);
  visit(Info{"power", "Exponent of visibility in the image that is written; 1 changes nothing.",
             0.1f, 16.0f},
        settings.power);
  visit(Info{"intensity", "Factor of occlusion in the image that is written; 1 changes nothing.",
             0.0f, 16.0f},
        settings.intensity);
  visit(Info{"bent_normal", "Also the mean visible direction."}, settings.bent_normal);
  visit(Info{"specular", "How specular occlusion is found."}, settings.specular);
  visit(Info{"precision", "Bits of the results."}, settings.precision);
}

}  // namespace alcove::sample
