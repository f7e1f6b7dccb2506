#pragma once

#include "scene/scene.h"

namespace alcove::sample {

// Two scenes that need other settings than architecture does. Lengths are metres, +Y is up. Each
// has fewer than 50,000 triangles and no textures. Every call returns the same bytes.

// Generates a picket fence between bushes, grass and a wall: thin occluders with gaps between them.
// Its cameras are `fence` (the default), `bush` and `along`.
[[nodiscard]] Scene fence_scene();

// Generates hilly ground with rocks, trees, a hut and posts: open surfaces and occluders far from
// each other, many of them smaller than a few pixels. Its cameras are `valley` (the default), `hut`
// and `ridge`.
[[nodiscard]] Scene terrain_scene();

}  // namespace alcove::sample
