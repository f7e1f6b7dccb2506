#pragma once

#include <tiny_gltf.h>

#include <vector>

#include "support/glm.h"
#include "support/result.h"

namespace alcove::sample {

// The instances of a node by EXT_mesh_gpu_instancing, as the file stores them.
class NodeInstances {
 public:
  // Reads the instances, at most `most`. The result is empty if the node does not have the
  // extension. Error texts are the end of a sentence whose beginning the caller adds.
  [[nodiscard]] static Result<NodeInstances> read(const tinygltf::Model& model,
                                                  const tinygltf::Node& node, uint64_t most);

  [[nodiscard]] size_t size() const { return count_; }
  // Returns the transform of an instance relative to the node. `instance` is below size().
  [[nodiscard]] glm::dmat4 at(size_t instance) const;

 private:
  size_t count_ = 0;
  // 3, 4 and 3 numbers for each instance. An attribute that the file does not have is empty.
  std::vector<float> translations_, rotations_, scales_;
};

// A node that is drawn. If it names a mesh, that mesh exists, and its skin with all joints too.
struct DrawnNode {
  size_t node;
  NodeInstances instances;  // empty: one instance with the node's own transform
};

// The transforms of all nodes of a file, and the nodes that are drawn.
struct NodeTree {
  std::vector<glm::dmat4> world_from_node;  // by node
  std::vector<DrawnNode> drawn;             // in the order of the tree
  size_t repeats = 0;  // how often the scene reaches a node again, which is drawn once
};

// Computes the transforms of the nodes of a file. The drawn nodes are those of the default scene,
// or all if the file has no scenes, except those that KHR_node_visibility hides. At most
// `most_instances` instances are read. Error texts are the end of a sentence whose beginning the
// caller adds.
[[nodiscard]] Result<NodeTree> read_nodes(const tinygltf::Model& model, uint64_t most_instances);

// Returns the origin of world space in the coordinates of the file. It is zero, unless the scene is
// farther from the file's origin than 256 times its own size. Then it is a point near the scene's
// centre, because floats at such a distance round to 2^-16 of the size. The centre is the median of
// a few vertices of each drawn primitive, at most a million, and the size is the distance from it
// within which three quarters of them lie, so that a few distant parts change neither.
[[nodiscard]] glm::dvec3 chosen_origin(const tinygltf::Model& model, const NodeTree& nodes);

}  // namespace alcove::sample
