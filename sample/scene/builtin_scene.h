#pragma once

#include "scene/scene.h"

namespace alcove::sample {

// An arcade around a courtyard, made in code: columns, arches, a coffered ceiling, steps, a
// balustrade, a lattice, a plant, a vase; thin and thick occluders, glossy and rough materials of
// several albedos. Metres, +Y up, under 50 thousand triangles, no textures. Cameras `arcade` (the
// default), `court` and `plant`. The same bytes on every call.
[[nodiscard]] Scene builtin_scene();

}  // namespace alcove::sample
