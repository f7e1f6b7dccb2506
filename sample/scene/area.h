#pragma once

#include <cstddef>

#include "scene/scene.h"

namespace alcove::sample {

// The normal of the triangle whose indices begin at `first`, times twice its area. In double,
// because the cross product of a sliver's edges cancels, and because squares of very small or large
// lengths are outside of the range of floats.
[[nodiscard]] glm::dvec3 area_of(const Mesh& mesh, size_t first);

}  // namespace alcove::sample
