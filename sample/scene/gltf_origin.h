#pragma once

#include <tiny_gltf.h>

#include <cstdint>

#include "scene/gltf_layout.h"

namespace alcove::sample {

// Returns the origin of world space in the coordinates of the file. It is zero, unless the scene is
// farther from the file's origin than 256 times its own size. Then it is a point near the scene's
// centre, because floats at such a distance round to 2^-16 of the size. The centre is the median of
// the centres of all primitives, and the size is the distance from it within which three quarters
// of them lie, so that a few distant parts change neither. At most `most_vertices` vertices are
// read.
[[nodiscard]] glm::dvec3 chosen_origin(const tinygltf::Model& model, const Layout& layout,
                                       uint64_t most_vertices);

}  // namespace alcove::sample
