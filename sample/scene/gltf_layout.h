#pragma once

#include <tiny_gltf.h>

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "scene/gltf_placement.h"
#include "support/glm.h"

namespace alcove::sample {

// A node that is drawn. Its instances have transforms relative to the node.
struct DrawnNode {
  size_t node;
  NodeInstances instances;  // empty: one instance with the node's own transform
};

// The transforms of all nodes of a file, and the nodes that are drawn.
struct Layout {
  std::vector<glm::dmat4> world_from_node;  // by node
  std::vector<DrawnNode> drawn;             // in the order of the node tree
};

// Computes the transforms of the nodes of a file. The drawn nodes are those of the default scene,
// or all if the file has no scenes, except those that KHR_node_visibility hides. At most
// `most_instances` instances are read. Error texts are the end of a sentence whose beginning the
// caller adds.
[[nodiscard]] tl::expected<Layout, std::string> place_nodes(const tinygltf::Model& model,
                                                            uint64_t most_instances);

// Returns the origin of world space in the coordinates of the file. It is zero, unless the scene is
// farther from the file's origin than 256 times its own size. Then it is a point near the scene's
// centre, because floats at such a distance round to 2^-16 of the size. The centre is the median of
// a few vertices of each drawn primitive, at most a million, and the size is the distance from it
// within which three quarters of them lie, so that a few distant parts change neither.
[[nodiscard]] glm::dvec3 chosen_origin(const tinygltf::Model& model, const Layout& layout);

}  // namespace alcove::sample
