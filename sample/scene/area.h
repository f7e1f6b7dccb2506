#pragma once

#include <cstddef>

#include "scene/scene.h"

namespace alcove::sample {

// Returns the normal of the triangle whose indices begin at `first`, multiplied by twice its area.
// It is computed in double, because the cross product of the edges of a narrow triangle cancels,
// and because the squares of very small or large lengths are outside the range of floats.
[[nodiscard]] glm::dvec3 area_of(const Mesh& mesh, size_t first);

}  // namespace alcove::sample
