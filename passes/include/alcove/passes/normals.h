// Normals from depth, for engines without a normal buffer.
#pragma once

#include "alcove/passes/frame.h"

namespace alcove::passes {

// Adds a pass that computes normals from `depth`, a linear depth of add_linear_depth(). Returns an
// RGBA16_SFLOAT texture of unit normals in view space that point towards the eye. On each image
// axis the normal uses the neighbour on the side where the depths continue the pixel's depth
// better, so that surfaces on both sides of a silhouette do not mix. The sky gets the direction to
// the eye.
//
// Errors: a null texture, or a view whose matrices the passes cannot use.
[[nodiscard]] tl::expected<framegraph::Texture, Error> add_normals(const Frame& frame,
                                                                   framegraph::Texture depth);

}  // namespace alcove::passes
