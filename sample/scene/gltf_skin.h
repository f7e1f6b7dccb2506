#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <vector>

#include "support/glm.h"
#include "support/result.h"

namespace alcove::sample {

// Returns, for each joint of a skin, the transform from the mesh's bind pose to the joint's pose in
// the file's nodes (glTF 2.0 section 3.7.3.1). The skin and its joints exist, and `world_from_node`
// has the transform of each node. A skin may have at most `most` joints. Error texts are the end of
// a sentence whose beginning the caller adds.
[[nodiscard]] Result<std::vector<glm::dmat4>> joint_matrices(
    const tinygltf::Model& model, int skin, const std::vector<glm::dmat4>& world_from_node,
    uint64_t most);

// The affine transform of each vertex of a primitive: the same for all vertices, or the weighted
// mean of the joint matrices of a skin (glTF 2.0 section 3.7.3.3), which replaces the transform of
// the mesh's node.
class VertexTransforms {
 public:
  explicit VertexTransforms(const glm::dmat4& transform) : transform_(transform) {}

  // Reads the sets JOINTS_n and WEIGHTS_n of the vertices of a primitive, which are numbered in the
  // order of `vertices`. `joints` is the result of joint_matrices(). Weights are normalised; a
  // vertex without weights follows its first joint. `most_sets` is the largest allowed number of
  // vertices times the number of sets. Error texts are the end of a sentence whose beginning the
  // caller adds.
  [[nodiscard]] static Result<VertexTransforms> skinned(const tinygltf::Model& model,
                                                        const tinygltf::Primitive& primitive,
                                                        const std::vector<uint32_t>& vertices,
                                                        const std::vector<glm::dmat4>& joints,
                                                        uint64_t most_sets);

  [[nodiscard]] glm::dmat4 at(size_t vertex) const;

 private:
  glm::dmat4 transform_;
  const std::vector<glm::dmat4>* joints_ = nullptr;
  size_t influences_ = 0;           // number of joints per vertex; 0: all have transform_
  std::vector<uint16_t> joint_of_;  // `influences_` for each vertex
  std::vector<float> weight_of_;    // parallel to joint_of_; the weights of a vertex sum to 1
};

}  // namespace alcove::sample
