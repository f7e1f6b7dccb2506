// The passes in their usual order: from a depth buffer to visibility, bent normals and specular
// occlusion.
#pragma once

#include "alcove/passes/gtao.h"
#include "alcove/passes/gtso.h"
#include "alcove/passes/linear_depth.h"
#include "alcove/passes/normals.h"
#include "alcove/passes/reconstruct.h"
#include "alcove/passes/settings.h"

namespace alcove::passes {

struct OcclusionInputs {
  // The depth buffer that the view's projection wrote. If it has several samples per pixel, a pass
  // first copies sample 0.
  framegraph::Texture depth_ndc;
  VkFormat depth_format = VK_FORMAT_UNDEFINED;  // see GtaoInputs::depth_format
  framegraph::Texture normals;                  // unit vectors; null: they are made from depth
  NormalConvention normal_convention;
  framegraph::Texture motion;     // as ReconstructInputs::motion; null: only the camera moves
  framegraph::Texture roughness;  // perceptual, [0,1]; null: OcclusionSettings::roughness
  // The depth of back faces, for ThicknessUnit::back_faces. It is ignored unless
  // needs_back_depth(). Draw the scene a second time with front faces culled, with the same
  // projection, size, clear value and depth test, so that the nearest back face is kept: there the
  // view ray leaves the first solid that it enters. A pixel's occluder has the thickness of the
  // settings instead if this depth is the sky or NaN, or is behind `depth_ndc` by less than a
  // ten-thousandth of the distance.
  framegraph::Texture back_depth_ndc;
  // The second depth layer, for OcclusionSettings::depth_layers = 2. It is ignored unless
  // needs_second_depth(). It holds the nearest front face that the first layer hides. Draw the
  // scene a second time with back faces culled, and discard fragments that are not behind
  // `depth_ndc` (for example by at least a thousandth of the distance). If this depth is the sky or
  // NaN at a pixel, the second layer has no occluder there.
  framegraph::Texture second_depth_ndc;
  // A mask of surfaces, R8_UNORM or R8_UINT, as AlcoveView::mask (alcove.h); null: there is none.
  framegraph::Texture mask;
  std::uint32_t not_receiving = 0;
  std::uint32_t not_occluding = 0;
  // Textures of the caller for the outputs: see ReconstructInputs::into.
  Occlusion into;
  MotionConvention motion_convention;
  VisibilityChannel visibility_channel = VisibilityChannel::all;  // see ReconstructInputs
  // Whether the outputs have half the depth's size: see ReconstructInputs::half_size_results.
  // Specular occlusion with `table` and `cone` is then not available.
  bool half_size_outputs = false;
};

struct OcclusionOutputs {
  // One channel, [0,1], 1 is open. Null if neither the settings nor their specular model need it.
  framegraph::Texture visibility;
  // Unit vectors in xyz, in the space of `normals`. Null if no bent normals were requested.
  framegraph::Texture bent_normal;
  // One channel that multiplies specular probe light, [0,1], 1 is open. Null if not requested.
  framegraph::Texture specular;
  // Linear depth from add_linear_depth(). It is null unless it was requested, or specular occlusion
  // or normals from depth need it.
  framegraph::Texture linear_depth;
  // The given ones, or normals from depth in view space. Null if none were given and depth has
  // several samples per pixel.
  framegraph::Texture normals;
};

// Adds all passes that the settings need. The graph culls passes whose results are not read. Bent
// normals are in the space of the given normals, or in view space if no normals are given. For
// several views in a frame (for example both eyes), call this once per view with different history
// names. The noise depends only on the pixel and the frame number, so that it is the same in all
// views.
//
// Errors: those of the passes that the settings need.
[[nodiscard]] tl::expected<OcclusionOutputs, Error> add_occlusion(
    const Frame& frame, const OcclusionInputs& inputs, const OcclusionSettings& settings,
    std::string_view history_name = "occlusion");

}  // namespace alcove::passes
