#pragma once

#include <tiny_gltf.h>

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "scene/gltf_placement.h"
#include "support/glm.h"

namespace alcove::sample {

// A node that is drawn, with the instances that it adds to its own transform.
struct DrawnNode {
  size_t node;
  NodeInstances instances;  // empty: one, with the transform of the node
};

// The transforms of a file's nodes.
struct Layout {
  std::vector<glm::dmat4> world_from_node;  // by node
  std::vector<DrawnNode> drawn;             // in the order of the tree
};

// Places the nodes of a file. Drawn are those of the default scene, or all if the file has no
// scenes, without those that KHR_node_visibility hides. At most `most_instances` instances are
// read. Errors are the end of a sentence.
[[nodiscard]] tl::expected<Layout, std::string> place_nodes(const tinygltf::Model& model,
                                                            uint64_t most_instances);

}  // namespace alcove::sample
