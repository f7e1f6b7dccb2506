#pragma once

#include <tiny_gltf.h>

#include <cstdint>

#include "scene/gltf_layout.h"

namespace alcove::sample {

// The origin of world space in the space of the file. Zero, unless the scene is further from it
// than 256 times its own size; then a point near its centre, because floats at such a distance
// round to 2^-16 of the size. Distance and size are medians over the parts of meshes, so that a few
// parts elsewhere do not change them. At most `most_vertices` vertices are read.
[[nodiscard]] glm::dvec3 chosen_origin(const tinygltf::Model& model, const Layout& layout,
                                       uint64_t most_vertices);

}  // namespace alcove::sample
