#pragma once

#include <vector>

#include "scene/scene.h"

namespace alcove::sample {

// The tangents of a mesh with normals for a normal map, one for each of its indices: the direction
// in which the map's u grows, in the space of the mesh, and in w the side of the bitangent
// w * cross(normal, tangent). Those of the file where the mesh has them; otherwise they follow the
// rules of MikkTSpace, as glTF asks for: corners of equal position, normal and texture coordinates
// are one vertex, and its tangent is the mean of the triangles around it that are connected by
// edges and are not mirrored in the map, weighted by their angles in the normal's plane. Unit, or
// zero where the texture coordinates have no area.
[[nodiscard]] std::vector<glm::vec4> corner_tangents(const Mesh& mesh, const TextureUse& map);

}  // namespace alcove::sample
