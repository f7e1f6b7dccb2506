// Makes the depth buffers that the passes read of the one that the engine gives.
#pragma once

#include "alcove/passes/work.h"

namespace alcove::passes {

struct Depths {
  framegraph::Texture all;        // with one sample per pixel
  framegraph::Texture receivers;  // with sky in the place of surfaces that do not receive occlusion
  framegraph::Texture occluders;  // with kNoOccluder in the place of surfaces that do not occlude
};

// Describes the passes that copy sample 0 of depth and that apply a mask. Without several samples
// and without a mask there are none, and all three are the given depth. Errors: a mask whose
// format, size or bits cannot be used, or areas outside of the image.
[[nodiscard]] tl::expected<Depths, Error> describe_depths(WorkList& list, const WorkFrame& frame,
                                                          const OcclusionInputs& inputs);

}  // namespace alcove::passes
