#pragma once

#include <tiny_gltf.h>

#include "scene/gltf_layout.h"

namespace alcove::sample {

// Returns the origin of world space in the coordinates of the file. It is zero, unless the scene is
// farther from the file's origin than 256 times its own size. Then it is a point near the scene's
// centre, because floats at such a distance round to 2^-16 of the size. The centre is the median of
// a few vertices of each drawn primitive, at most a million, and the size is the distance from it
// within which three quarters of them lie, so that a few distant parts change neither.
[[nodiscard]] glm::dvec3 chosen_origin(const tinygltf::Model& model, const Layout& layout);

}  // namespace alcove::sample
