// Linear depth, and a pyramid of it that keeps both sides of an edge apart. Normals from depth,
// specular models and lighting read it. The search and the filter read the depth buffer itself.
#pragma once

#include <cstdint>

#include "alcove/passes/frame.h"

namespace alcove::passes {

// In: `depth_ndc`, a depth texture (any depth or R32 float format) as the view's projection wrote
// it. Out: R32_SFLOAT, the distance along the view direction in scene units, 1e12 for the sky, for
// what is not a number and for what is infinitely far. Depth stays 32-bit because half floats
// overflow beyond 65504 and band at grazing angles.
//
// `mips` is 1 to 5; an image too small for so many gets all that it can have. Mip k + 1
// averages those of the four texels of mip k that lie within 2^k `reach` (scene units, over 0; not
// read with one mip) of the farthest that is not sky: wholly up to half of it, fading to nothing at
// all of it; sky where three of the four are sky. No pass of Alcove reads mips above 0.
//
// Errors: a texture that is missing, a view that cannot be used, mips or reach out of range.
[[nodiscard]] tl::expected<framegraph::Texture, Error> add_linear_depth(
    const Frame& frame, framegraph::Texture depth_ndc, std::uint32_t mips, float reach);

}  // namespace alcove::passes
