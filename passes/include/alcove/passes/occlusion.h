// The passes in their usual order: from a depth buffer to visibility, bent normals and specular
// occlusion.
#pragma once

#include <cstdint>

#include "alcove/passes/gtao.h"
#include "alcove/passes/gtso.h"
#include "alcove/passes/linear_depth.h"
#include "alcove/passes/normals.h"
#include "alcove/passes/reconstruct.h"
#include "alcove/passes/settings.h"

namespace alcove::passes {

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
  // One channel, [0,1], 1 is open. Null if neither the settings nor their specular model need it.
  framegraph::Texture visibility;
  // Unit vectors in xyz, in the space of `normals`. Null if no bent normals were requested.
  framegraph::Texture bent_normal;
  // One channel that multiplies specular probe light, [0,1], 1 is open. Null if not requested.
  framegraph::Texture specular;
  // Linear depth from add_linear_depth. Null if neither the settings, nor their
  // specular model, nor the computation of normals needs it.
  framegraph::Texture linear_depth;
  framegraph::Texture normals;  // those given, or those made from depth, in view space
};

// Adds all passes that the settings need. The graph culls those whose results are not read. Bent
// normals are in the space of the given normals, or in view space if no normals are given. For
// several views of a frame (both eyes, for example), call this once per view; each has histories of
// its own. Noise depends on pixel and frame alone, so it is the same in all views.
//
// Errors: those of the passes that the settings need.
[[nodiscard]] tl::expected<OcclusionOutputs, Error> add_occlusion(
    const Frame& frame, const OcclusionInputs& inputs, const OcclusionSettings& settings,
    std::string_view history_name = "occlusion");

}  // namespace alcove::passes
