#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "support/glm.h"

namespace alcove::sample {

// The accessors of JOINTS_n and WEIGHTS_n.
struct JointSet {
  int joints;
  int weights;
};

// The affine transform of each vertex of a primitive: one for all, or the weighted mean of the
// joints of a skin (glTF 2.0 section 3.7.3.3), which replaces the transform of the mesh's node.
class VertexPlacement {
 public:
  explicit VertexPlacement(const glm::dmat4& transform) : transform_(transform) {}

  // Reads JOINTS_n and WEIGHTS_n of a primitive of `vertices`. `joints` are those of
  // joint_matrices(). Weights are normalised; a vertex without weights follows its first joint.
  // `most_sets` bounds the number of vertices times the number of sets n. Errors are the end of a
  // sentence.
  [[nodiscard]] static tl::expected<VertexPlacement, std::string> skinned(
      const tinygltf::Model& model, const tinygltf::Primitive& primitive, size_t vertices,
      const std::vector<glm::dmat4>& joints, uint64_t most_sets);

  [[nodiscard]] glm::dmat4 at(size_t vertex) const;

 private:
  // Reads a set into the influences of each vertex from `first_influence` on, not normalised.
  [[nodiscard]] tl::expected<void, std::string> read_set(const tinygltf::Model& model,
                                                         const JointSet& set, size_t vertices,
                                                         size_t first_influence);

  glm::dmat4 transform_{1.0};
  const std::vector<glm::dmat4>* joints_ = nullptr;  // null: transform_ holds everywhere
  size_t influences_ = 0;                            // joints of each vertex
  std::vector<uint16_t> joint_of_;                   // `influences_` for each vertex
  std::vector<float> weight_of_;                     // parallel to it, sum 1
};

// For each joint of a skin the transform from the mesh's bind pose to the joint's pose, as the
// file's nodes give it. `placed` holds the transform of each node. A skin has at most `most`
// joints. Errors are the end of a sentence.
[[nodiscard]] tl::expected<std::vector<glm::dmat4>, std::string> joint_matrices(
    const tinygltf::Model& model, int skin, const std::vector<glm::dmat4>& placed, uint64_t most);

// A node's own transform from its matrix, or from translation, rotation and scale.
[[nodiscard]] glm::dmat4 local_transform(const tinygltf::Node& node);

// The instances that EXT_mesh_gpu_instancing gives a node, as the file stores them.
class NodeInstances {
 public:
  // Empty where the node does not have the extension. At most `most`. Errors are the end of a
  // sentence.
  [[nodiscard]] static tl::expected<NodeInstances, std::string> read(const tinygltf::Model& model,
                                                                     const tinygltf::Node& node,
                                                                     uint64_t most);

  [[nodiscard]] size_t size() const { return count_; }
  // The transform of an instance relative to the node. `instance` is below size().
  [[nodiscard]] glm::dmat4 at(size_t instance) const;

 private:
  size_t count_ = 0;
  // 3, 4 and 3 numbers for each instance; an attribute that the file does not have is empty.
  std::vector<float> translations_, rotations_, scales_;
};

}  // namespace alcove::sample
