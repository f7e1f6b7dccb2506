#pragma once

#include <vector>

#include "scene/scene.h"

namespace alcove::sample {

// Returns the tangents that a normal map needs, one for each index of a mesh with normals. xyz is
// the direction in which the map's u increases, in the space of the mesh: unit, or zero if the
// texture coordinates have no area. The bitangent is w * cross(normal, tangent).
//
// If the mesh has tangents, these are returned. Otherwise they follow the rules of MikkTSpace, as
// glTF demands: corners with equal position, normal and texture coordinates are one vertex. Its
// tangent is the mean over its triangles that are connected by edges and have the same orientation
// in the map, weighted by their angles in the plane of the normal.
[[nodiscard]] std::vector<glm::vec4> corner_tangents(const Mesh& mesh, const TextureUse& map);

}  // namespace alcove::sample
