// The parameters of shaders/reconstruct.comp.
#pragma once

#include "alcove/passes/work.h"
#include "maths/projection.h"
#include "reconstruct_parameters.h"

namespace alcove::passes {

// Returns all parameters except the size of the history's texture. `previous` is the previous
// frame's projection. ReconstructParameters::largest_weight is set to its value for a view that is
// not static.
[[nodiscard]] maths::ReconstructParameters reconstruct_parameters(
    const WorkFrame& frame, const maths::Projection& projection, const maths::Projection& previous,
    const ReconstructInputs& inputs, const OcclusionSettings& settings);

}  // namespace alcove::passes
