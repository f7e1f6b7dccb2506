// Depth in the form that the searches and filters read: add_gtao and add_reconstruct. It is not the
// linear depth of linear_depth.h, which normals, specular models and lighting read.
#pragma once

#include <string_view>

#include "alcove/passes/frame.h"

namespace alcove::passes {

// In: `depth_ndc`, a depth texture (any depth or R32 float format) as the view's projection wrote
// it. Out: R32_SFLOAT, 1 / (distance along the view direction, scene units) in perspective and the
// distance itself in orthographic views: linear along the image of any plane. The sky, and what is
// not a number, is 1e-12 and 1e12. 32 bits because half floats overflow and band at grazing angles.
// `name` is that of pass and texture.
//
// Errors: a texture that is missing, a view that cannot be used.
[[nodiscard]] tl::expected<framegraph::Texture, Error> add_inverse_depth(
    const Frame& frame, framegraph::Texture depth_ndc, std::string_view name = "inverse depth");

}  // namespace alcove::passes
