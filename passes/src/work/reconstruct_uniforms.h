// The parameters of shaders/reconstruct.comp and reconstruct_half.comp.
#pragma once

#include "maths/projection.h"
#include "reconstruct_parameters.h"
#include "work/describe_view.h"

namespace alcove::passes {

// The frame before, with which history is reprojected; this frame if there is no history.
struct PreviousFrame {
  const AlcoveCamera& camera;
  maths::Projection projection;
  bool is_same = true;  // nothing has moved: the camera is the same, and there is no motion image
};

// Returns all parameters except the size of the history's texture.
// ReconstructParameters::largest_weight is set to its value for a view that is not static.
[[nodiscard]] maths::ReconstructParameters reconstruct_parameters(const ViewInputs& view,
                                                                  const PreviousFrame& previous);

}  // namespace alcove::passes
