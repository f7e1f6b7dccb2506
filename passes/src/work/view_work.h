// All work of a view: occlusion, and multi-bounce if there is a texture for it.
#pragma once

#include "alcove/passes/work.h"

namespace alcove::passes {

struct ViewInputs {
  OcclusionInputs occlusion;
  framegraph::Texture albedo;
  framegraph::Texture multi_bounce;  // the texture to write; null: none
};

[[nodiscard]] tl::expected<OcclusionOutputs, Error> describe_view(
    WorkList& list, const WorkFrame& frame, const ViewInputs& inputs,
    const OcclusionSettings& settings);

}  // namespace alcove::passes
