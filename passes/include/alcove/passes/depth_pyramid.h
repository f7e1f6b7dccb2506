// Linear depth, and a pyramid of it that keeps both sides of an edge apart.
#pragma once

#include <cstdint>

#include "alcove/passes/frame.h"

namespace alcove::passes {

// In: `depth_ndc`, a depth texture (any depth or R32 float format) as the view's projection wrote
// it. Out: R32_SFLOAT, the distance along the view direction in scene units, 1e12 for the sky, for
// what is not a number and for what is infinitely far. Mip k + 1 averages the four texels of mip k
// that lie near the nearest of them: `reach` (scene units) is how near. `mips` is 1 to 5;
// an image with fewer gets all it has. Depth stays 32-bit because half floats overflow beyond 65504
// and band at grazing angles.
[[nodiscard]] tl::expected<framegraph::Texture, Error> add_depth_pyramid(
    const Frame& frame, framegraph::Texture depth_ndc, std::uint32_t mips, float reach);

}  // namespace alcove::passes
