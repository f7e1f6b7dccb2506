// Multi-bounce: visibility with the light that occluders reflect ([Jimenez 2016], section 5).
#pragma once

#include "alcove/passes/frame.h"

namespace alcove::passes {

struct MultiBounceInputs {
  framegraph::Texture visibility;  // [0,1], 1 open
  framegraph::Texture albedo;      // linear RGB, [0,1], of the size of the visibility
  framegraph::Texture into;        // the texture to write completely; null: a transient
};

// Adds a pass that computes visibility per colour channel. Returns an RGB texture with the fraction
// of the environment's light that reaches each pixel after any number of bounces, if all surfaces
// have the pixel's own albedo. It is at least the visibility and at most 1. Multiply diffuse probe
// light by it instead of by the visibility. The format of a transient is RGBA8_UNORM, RGBA16_SFLOAT
// or RGBA32_SFLOAT, by `precision`.
//
// Errors: a missing input, or inputs of different sizes.
[[nodiscard]] tl::expected<framegraph::Texture, Error> add_multi_bounce(
    const Frame& frame, const MultiBounceInputs& inputs, Precision precision = Precision::unorm8);

}  // namespace alcove::passes
