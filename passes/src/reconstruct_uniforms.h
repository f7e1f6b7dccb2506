// The parameters of shaders/reconstruct.comp.
#pragma once

#include "alcove/passes/reconstruct.h"
#include "maths/projection.h"
#include "reconstruct_parameters.h"

namespace alcove::passes {

// All parameters but the size of the history's texture. `previous` is the previous frame's
// projection. The largest weight is that of a moving camera.
[[nodiscard]] maths::ReconstructParameters reconstruct_parameters(
    const Frame& frame, const maths::Projection& projection, const maths::Projection& previous,
    const ReconstructInputs& inputs, const OcclusionSettings& settings);

}  // namespace alcove::passes
