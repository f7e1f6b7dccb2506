// Normals from depth, for engines that keep none.
#pragma once

#include "alcove/passes/frame.h"

namespace alcove::passes {

// In: `depth`, linear depth as add_linear_depth makes it. Out: RGBA16_SFLOAT, unit normals in view
// space towards the eye. Each axis takes the side whose depth continues the pixel's own better, so
// that normals do not residual across silhouettes. Sky gets the direction to the eye.
//
// Errors: a texture that is missing, a view that cannot be used.
[[nodiscard]] tl::expected<framegraph::Texture, Error> add_normals(const Frame& frame,
                                                                   framegraph::Texture depth);

}  // namespace alcove::passes
