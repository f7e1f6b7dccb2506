#include "scene/gltf_skin.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <numeric>
#include <span>

#include "scene/gltf_accessor.h"

namespace alcove::sample {
Result<std::vector<glm::dmat4>> joint_matrices(const tinygltf::Model& model, int index,
                                               const std::vector<glm::dmat4>& world_from_node,
                                               uint64_t most) {
  const tinygltf::Skin& skin = model.skins[static_cast<size_t>(index)];
  const std::string name = "has skin " + std::to_string(index) + ", which ";
  constexpr size_t kMost = UINT16_MAX + size_t{1};  // JOINTS_n are 16-bit at most
  if (skin.joints.empty() || skin.joints.size() > kMost)
    return Failure(name + "has " + std::to_string(skin.joints.size()) + " joints");
  if (skin.joints.size() > most)
    return Failure(name + "takes the scene past the number of joints that is read here");
  std::vector<float> inverse_bind;
  if (skin.inverseBindMatrices >= 0) {
    ALCOVE_TRY(
        inverse_bind,
        read_floats(model, skin.inverseBindMatrices, 16, kMost).map_error(with_prefix(name)));
    if (inverse_bind.size() < 16 * skin.joints.size())
      return Failure(name + "has fewer inverse bind matrices than joints");
  }
  std::vector<glm::dmat4> out;
  for (size_t i = 0; i < skin.joints.size(); ++i) {
    out.push_back(world_from_node[static_cast<size_t>(skin.joints[i])]);
    if (!inverse_bind.empty()) out.back() *= glm::dmat4(glm::make_mat4(&inverse_bind[16 * i]));
  }
  return out;
}

Result<VertexTransforms> VertexTransforms::skinned(const tinygltf::Model& model,
                                                   const tinygltf::Primitive& primitive,
                                                   const std::vector<uint32_t>& vertices,
                                                   const std::vector<glm::dmat4>& joints,
                                                   uint64_t most_sets) {
  constexpr int kJointsPerSet = 4;
  const auto accessor = [&](const char* name, size_t set) {
    return attribute(primitive.attributes, name + std::to_string(set));
  };
  size_t sets = 0;
  while (accessor("JOINTS_", sets) >= 0 && accessor("WEIGHTS_", sets) >= 0) ++sets;
  if (!vertices.empty() && sets > most_sets / vertices.size()) {
    return Failure("has too many joints and weights: " + std::to_string(sets) + " sets for " +
                   std::to_string(vertices.size()) + " vertices");
  }
  VertexTransforms out(glm::dmat4(1.0));
  out.joints_ = &joints;
  out.influences_ = kJointsPerSet * sets;
  out.joint_of_.resize(vertices.size() * out.influences_);
  out.weight_of_.resize(vertices.size() * out.influences_);
  for (size_t set = 0; set < sets; ++set) {
    ALCOVE_TRY(const auto numbers,
               read_floats(model, accessor("JOINTS_", set), kJointsPerSet, 0, &vertices));
    ALCOVE_TRY(const auto weights,
               read_floats(model, accessor("WEIGHTS_", set), kJointsPerSet, 0, &vertices));
    for (size_t i = 0; i < numbers.size(); ++i) {
      const float joint = numbers[i];
      const float weight = std::isfinite(weights[i]) ? std::max(weights[i], 0.0f) : 0.0f;
      const bool exists = joint >= 0.0f && joint < static_cast<float>(joints.size());
      if (!exists && weight > 0.0f) {
        return Failure("has a vertex of joint " + std::to_string(joint) + ", and its skin has " +
                       std::to_string(joints.size()) + " joints");
      }
      const size_t at =
          i / kJointsPerSet * out.influences_ + kJointsPerSet * set + i % kJointsPerSet;
      out.joint_of_[at] = exists ? static_cast<uint16_t>(joint) : uint16_t{0};
      out.weight_of_[at] = weight;
    }
  }
  for (size_t v = 0; v < vertices.size() && sets > 0; ++v) {
    const std::span<float> weights(&out.weight_of_[v * out.influences_], out.influences_);
    float sum = std::accumulate(weights.begin(), weights.end(), 0.0f);
    if (!(sum > 0.0f)) weights[0] = sum = 1.0f;
    for (float& weight : weights) weight /= sum;
  }
  return out;
}

glm::dmat4 VertexTransforms::at(size_t vertex) const {
  if (influences_ == 0) return transform_;
  glm::dmat4 sum(0.0);
  for (size_t i = vertex * influences_; i < (vertex + 1) * influences_; ++i)
    if (weight_of_[i] > 0.0f) sum += (*joints_)[joint_of_[i]] * static_cast<double>(weight_of_[i]);
  return sum;
}

}  // namespace alcove::sample
