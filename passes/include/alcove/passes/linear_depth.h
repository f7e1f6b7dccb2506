// Linear depth: the distance of each pixel from the eye along the view direction. The passes for
// normals, specular occlusion (`table` and `cone`) and lighting read it. The occlusion search and
// the filter read the depth buffer itself.
#pragma once

#include "alcove/passes/frame.h"

namespace alcove::passes {

// Adds a pass that converts `depth_ndc` to linear depth. `depth_ndc` is a depth buffer, in any
// depth format or R32_SFLOAT, that the view's projection wrote. Returns an R32_SFLOAT texture of
// the same size with the distance along the view direction in scene units. Sky, NaN and infinitely
// far depths become 1e12. The format has 32 bits because a half float ends at 65504, and its steps
// are visible as bands at grazing angles.
//
// Errors: a null texture, or a view whose matrices the passes cannot use.
[[nodiscard]] tl::expected<framegraph::Texture, Error> add_linear_depth(
    const Frame& frame, framegraph::Texture depth_ndc);

}  // namespace alcove::passes
