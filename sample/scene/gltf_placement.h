#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "support/glm.h"

namespace alcove::sample {

// The accessors of one set of joints and weights, JOINTS_n and WEIGHTS_n.
struct JointSet {
  int joints;
  int weights;
};

// The affine transform of each vertex of a primitive: the same for all vertices, or the weighted
// mean of the joint matrices of a skin (glTF 2.0 section 3.7.3.3), which replaces the transform of
// the mesh's node.
class VertexPlacement {
 public:
  explicit VertexPlacement(const glm::dmat4& transform) : transform_(transform) {}

  // Reads the sets JOINTS_n and WEIGHTS_n of the vertices of a primitive, which are numbered in the
  // order of `vertices`. `joints` is the result of joint_matrices(). Weights are normalised; a
  // vertex without weights follows its first joint. `most_sets` is the largest allowed number of
  // vertices times the number of sets. Error texts are the end of a sentence whose beginning the
  // caller adds.
  [[nodiscard]] static tl::expected<VertexPlacement, std::string> skinned(
      const tinygltf::Model& model, const tinygltf::Primitive& primitive,
      const std::vector<uint32_t>& vertices, const std::vector<glm::dmat4>& joints,
      uint64_t most_sets);

  [[nodiscard]] glm::dmat4 at(size_t vertex) const;

 private:
  // Reads one set into the influences of each vertex, from index `first_influence` on. Weights are
  // not yet normalised.
  [[nodiscard]] tl::expected<void, std::string> read_set(const tinygltf::Model& model,
                                                         const JointSet& set,
                                                         const std::vector<uint32_t>& vertices,
                                                         size_t first_influence);

  glm::dmat4 transform_{1.0};
  const std::vector<glm::dmat4>* joints_ = nullptr;  // null: all vertices have transform_
  size_t influences_ = 0;                            // number of joints per vertex
  std::vector<uint16_t> joint_of_;                   // `influences_` for each vertex
  std::vector<float> weight_of_;  // parallel to joint_of_; the weights of a vertex sum to 1
};

// Returns, for each joint of a skin, the transform from the mesh's bind pose to the joint's pose in
// the file's nodes. `placed` has the transform of each node. A skin may have at most `most` joints.
// Error texts are the end of a sentence whose beginning the caller adds.
[[nodiscard]] tl::expected<std::vector<glm::dmat4>, std::string> joint_matrices(
    const tinygltf::Model& model, int skin, const std::vector<glm::dmat4>& placed, uint64_t most);

// Returns a node's local transform, from its matrix or from its translation, rotation and scale.
[[nodiscard]] glm::dmat4 local_transform(const tinygltf::Node& node);

// The instances of a node by EXT_mesh_gpu_instancing, as the file stores them.
class NodeInstances {
 public:
  // Reads the instances, at most `most`. The result is empty if the node does not have the
  // extension. Error texts are the end of a sentence whose beginning the caller adds.
  [[nodiscard]] static tl::expected<NodeInstances, std::string> read(const tinygltf::Model& model,
                                                                     const tinygltf::Node& node,
                                                                     uint64_t most);

  [[nodiscard]] size_t size() const { return count_; }
  // Returns the transform of an instance relative to the node. `instance` is below size().
  [[nodiscard]] glm::dmat4 at(size_t instance) const;

 private:
  size_t count_ = 0;
  // 3, 4 and 3 numbers for each instance. An attribute that the file does not have is empty.
  std::vector<float> translations_, rotations_, scales_;
};

}  // namespace alcove::sample
