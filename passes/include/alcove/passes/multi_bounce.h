// The light that occluders send back: Jimenez, Wu, Pesce and Jarabo 2016, section 5.
#pragma once

#include "alcove/passes/frame.h"

namespace alcove::passes {

struct MultiBounceInputs {
  framegraph::Texture visibility;  // one channel, [0,1], 1 open
  framegraph::Texture albedo;      // linear RGB, [0,1], as large as the visibility
  framegraph::Texture into;        // to be written, whole; null: a transient of `precision`
};

// Out: RGB, the share of the environment's light that reaches each pixel after any number of
// bounces between surfaces of the pixel's own albedo; at least the visibility, at most 1. It
// multiplies diffuse probe light where the visibility would. Unorm8 is RGBA8_UNORM, float16
// RGBA16_SFLOAT, float32 RGBA32_SFLOAT. Errors: an input that is missing, or of another size than
// the rest.
[[nodiscard]] tl::expected<framegraph::Texture, Error> add_multi_bounce(
    const Frame& frame, const MultiBounceInputs& inputs, Precision precision = Precision::unorm8);

}  // namespace alcove::passes
