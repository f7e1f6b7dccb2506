#pragma once

#include "scene/scene.h"

namespace alcove::sample {

// Generates an arcade around a courtyard with columns, arches, a coffered ceiling, steps, a
// balustrade, a lattice, a plant and a vase. It has thin and thick occluders, and glossy and rough
// materials of several albedos. Lengths are metres, +Y is up. It has fewer than 50,000 triangles
// and no textures. Its cameras are `arcade` (the default), `court` and `plant`. Every call returns
// the same bytes.
[[nodiscard]] Scene builtin_scene();

}  // namespace alcove::sample
