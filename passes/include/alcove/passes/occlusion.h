// The passes in their usual order: from a depth buffer to visibility, bent normals and specular
// occlusion.
#pragma once

#include <cstdint>

#include "alcove/passes/gtao.h"
#include "alcove/passes/gtso.h"
#include "alcove/passes/linear_depth.h"
#include "alcove/passes/normals.h"
#include "alcove/passes/reconstruct.h"

namespace alcove::passes {

// How specular occlusion is found, the visible share of each surface's GGX lobe.
enum class Specular : std::uint8_t {
  none,
  slices,  // by the slices that visibility is found by: the lobe within their horizons or sectors
  // From visibility and bent normal, as GtsoSettings::model says.
  table,
  cone,
  smooth_cone,
  lagarde,
};

// Slices and steps of a search, how many pixels share one in a frame, and depth fetches a pixel and
// frame; but for the reference all have a history of 32 frames.
enum class Quality : std::uint8_t {
  low,        // 1 slice of 8 steps a side in 4x4 pixels: 1 fetch
  medium,     // 1 of 10 in 2x2: 5
  high,       // 2 of 16 in 2x2: 16
  ultra,      // 4 of 24 in 2x2: 48
  reference,  // 32 of 64 in each: 4096. By horizons, neither filtered nor averaged: the paper's own
};

// Everything that can be chosen: what gtao.h and reconstruct.h say of searches and filter, and what
// follows. quality_settings() gives a start.
struct OcclusionSettings : SearchSettings, FilterSettings {
  bool visibility = true;  // off where only others are wanted
  bool bent_normal = false;
  bool linear_depth = false;  // also hand on what lighting may want: OcclusionOutputs::linear_depth
  Specular specular = Specular::none;
  float roughness = 0.5f;               // perceptual, [0,1], of every pixel where no texture has it
  std::uint32_t roughness_channel = 0;  // of the roughness texture, 0 to 3
  Precision precision = Precision::unorm8;
  // The visibility that is written is 1 - intensity * (1 - visibility^power), cut to [0,1]: 1 and 1
  // change nothing and cost nothing. Above 0 to 16, and 0 to 16. Specular models and multi-bounce
  // read the visibility that is written.
  float power = 1.0f;
  float intensity = 1.0f;

  friend bool operator==(const OcclusionSettings&, const OcclusionSettings&) = default;
};

// The settings of a quality at a radius; all of them suit every scene.
[[nodiscard]] OcclusionSettings quality_settings(Quality quality, float radius);

struct OcclusionInputs {
  framegraph::Texture depth_ndc;       // as the view's projection wrote it
  framegraph::Texture normals;         // unit vectors; null: they are made from depth
  bool normals_in_view_space = false;  // else in world space
  framegraph::Texture motion;          // as ReconstructInputs::motion; null: only the camera moves
  framegraph::Texture roughness;       // perceptual, [0,1]; null: OcclusionSettings::roughness
  // For ThicknessUnit::back_faces, where needs_back_depth(); else ignored. The depth of the scene
  // drawn once more with front faces culled, and all else alike: projection, size, cleared to the
  // sky, the nearest face kept (LESS, GREATER where depth is reversed). The nearest, because that
  // is where a view ray leaves the solid that it enters first; the farthest is another solid's. Any
  // value is taken: where it is sky, not a number or not behind `depth_ndc` by more than a
  // ten-thousandth of the distance, the occluder's thickness is that of the settings.
  framegraph::Texture back_depth_ndc;
  // For two depth_layers, where needs_second_depth(); else ignored. The depth of the scene drawn
  // once more, all else alike, with back faces culled and fragments discarded that do not lie
  // behind `depth_ndc`, by a thousandth of its distance say: the nearest front face that the first
  // one hides. A solid's own back face would only say again how thick it is. Any value is taken:
  // where it is sky or not a number nothing is hidden.
  framegraph::Texture second_depth_ndc;
  // As ReconstructInputs::into: textures of the caller's for the results that the settings ask for.
  Occlusion into;
  NormalEncoding normal_encoding = NormalEncoding::signed_xyz;
  // Normals in view space have a z that grows away from the eye: engines whose camera looks along
  // +Z. Bent normals are then written so too.
  bool normals_forward_z = false;
  MotionConvention motion_convention;
};

struct OcclusionOutputs {
  // One channel, [0,1], 1 open; null where neither the settings nor their specular model want it.
  framegraph::Texture visibility;
  // xyz unit, in the space of `normals`; null where none was asked for.
  framegraph::Texture bent_normal;
  // One channel, multiplies specular probe light, [0,1], 1 open; null where none was asked for.
  framegraph::Texture specular;
  // As add_linear_depth makes it, of one mip; null where neither the settings nor their specular
  // model nor the making of normals want it.
  framegraph::Texture linear_depth;
  framegraph::Texture normals;  // those given, or those made from depth, in view space
};

// What is not read afterwards is culled by the graph, with all that only leads there. Bent normals
// are in the space of the given normals, in view space where none are given. Several views of a
// frame (both eyes, say) take a call each, with histories of their own; noise depends on pixel and
// frame alone, so it is the same in all.
//
// Errors: those of the passes that the settings need.
[[nodiscard]] tl::expected<OcclusionOutputs, Error> add_occlusion(
    const Frame& frame, const OcclusionInputs& inputs, const OcclusionSettings& settings,
    std::string_view history_name = "occlusion");

}  // namespace alcove::passes
