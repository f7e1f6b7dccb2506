// Normals from depth, for engines without a normal buffer. The occlusion passes compute those that
// they need themselves; this pass serves other passes of an engine.
#pragma once

#include "alcove/passes/frame.h"

namespace alcove::passes {

// Adds a pass that computes normals from `depth`, the linear depth from add_linear_depth(). Returns
// an RGBA16_SFLOAT texture of unit normals in view space that point towards the eye. On each image
// axis, the pass uses the one of the two neighbours whose depth continues the pixel's surface more
// smoothly, so that normals do not mix the surfaces on both sides of a silhouette. The sky gets the
// direction to the eye.
//
// Errors: a null texture, or a view whose matrices the passes cannot use.
[[nodiscard]] tl::expected<framegraph::Texture, Error> add_normals(const Frame& frame,
                                                                   framegraph::Texture depth);

}  // namespace alcove::passes
