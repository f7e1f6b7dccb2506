#pragma once

#include <vector>

#include "scene/scene.h"

namespace alcove::sample {

// The tangents that a mesh's normal map is read by, one for each of its indices: along the world
// direction in which the map's u grows, w the side of the bitangent. Those of the mesh where it has
// them. Else made from positions and texture coordinates: a corner takes the mean of the triangles
// that share its vertex and see the map from the same side, weighted by their angles, so that
// mirrored halves that share vertices keep a tangent each. Unit, or zero where coordinates say
// nothing.
[[nodiscard]] std::vector<glm::vec4> corner_tangents(const Mesh& mesh, const TextureUse& map);

}  // namespace alcove::sample
