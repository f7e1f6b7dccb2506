#pragma once

#include <cstddef>

#include "scene/scene.h"

namespace alcove::sample {

// Of the triangle whose indices begin at `first`: its normal times twice its area. In double: the
// cross product of a sliver's sides cancels, and squares of the very small and large are no floats.
[[nodiscard]] glm::dvec3 area_of(const Mesh& mesh, size_t first);

}  // namespace alcove::sample
