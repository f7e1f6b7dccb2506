// Makes pixels from what is reconstructed at half resolution.
#pragma once

#include "alcove/passes/work.h"

namespace alcove::passes {

struct UpsampleInputs {
  framegraph::Texture half;        // maths::pack_half_texel()
  framegraph::Texture half_depth;  // maths::half_texel_depth()
  framegraph::Texture residuals;  // maths::pack_half_residual(); null where there is no bent normal
  framegraph::Texture lobes;      // maths::LobeTexel; null where there is no lobe
  framegraph::Texture depth_ndc;  // as OcclusionInputs has it
  framegraph::Texture normals;    // as OcclusionInputs has it
  NormalConvention normal_convention;
};

// Describes the pass that writes `result`. Its textures have the size of the results and were
// created but not yet written. A texture of `result` that is null is not written.
//
// Errors: a view that cannot be used.
[[nodiscard]] tl::expected<Occlusion, Error> describe_upsample(WorkList& list,
                                                               const WorkFrame& frame,
                                                               const UpsampleInputs& inputs,
                                                               const Occlusion& result,
                                                               const OcclusionSettings& settings);

}  // namespace alcove::passes
