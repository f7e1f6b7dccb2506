#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "support/glm.h"

namespace alcove::sample {

// The affine transform of each vertex of a primitive: one for all, or the weighted mean of the
// joints of a skin (glTF 2.0 section 3.7.3.3), which replaces the transform of the mesh's node.
class VertexPlacement {
 public:
  explicit VertexPlacement(const glm::dmat4& transform) : transform_(transform) {}

  // `joints` as joint_matrices() gives them. Reads JOINTS_n and WEIGHTS_n of a primitive of
  // `vertices`; weights are normalised, and vertices without any follow their first joint. Errors
  // are the end of a sentence.
  [[nodiscard]] static tl::expected<VertexPlacement, std::string> skinned(
      const tinygltf::Model& model, const tinygltf::Primitive& primitive, size_t vertices,
      const std::vector<glm::dmat4>& joints);

  [[nodiscard]] glm::dmat4 at(size_t vertex) const;

 private:
  glm::dmat4 transform_{1.0};
  const std::vector<glm::dmat4>* joints_ = nullptr;  // null: transform_ holds everywhere
  size_t influences_ = 0;                            // joints of each vertex
  std::vector<uint16_t> joint_of_;                   // `influences_` for each vertex
  std::vector<float> weight_of_;                     // parallel to it, sum 1
};

// For each joint of a skin the transform from the mesh's bind pose to the joint's pose, as the
// file's nodes give it. `placed` holds the transform of each node. Errors are the end of a
// sentence.
[[nodiscard]] tl::expected<std::vector<glm::dmat4>, std::string> joint_matrices(
    const tinygltf::Model& model, int skin, const std::vector<glm::dmat4>& placed);

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
