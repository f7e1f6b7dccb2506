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
