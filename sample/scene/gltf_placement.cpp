#include "scene/gltf_placement.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numeric>
#include <optional>
#include <span>

#include "scene/gltf_accessor.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

constexpr int kJointsPerSet = 4;

glm::dmat4 transform_of(const glm::dvec3& translation, const glm::dquat& rotation,
                        const glm::dvec3& scale) {
  glm::dmat4 m(1.0);
  const double length = glm::length(rotation);
  if (length > 0.0) m = glm::mat4_cast(rotation / length);
  for (int c = 0; c < 3; ++c) m[c] *= scale[c];
  m[3] = glm::dvec4(translation, 1.0);
  return m;
}

// Returns the accessor of an attribute of EXT_mesh_gpu_instancing, or -1 if there is none.
int instance_attribute(const tinygltf::Value& extension, const char* name) {
  if (!extension.IsObject() || !extension.Has("attributes")) return -1;
  const tinygltf::Value& attributes = extension.Get("attributes");
  if (!attributes.IsObject() || !attributes.Has(name)) return -1;
  const tinygltf::Value& accessor = attributes.Get(name);
  return accessor.IsNumber() ? accessor.GetNumberAsInt() : -1;
}

// Returns the accessors of JOINTS_0 and WEIGHTS_0, JOINTS_1 and WEIGHTS_1 and so on, up to the
// first set that is missing.
std::vector<JointSet> joint_sets(const tinygltf::Primitive& primitive) {
  std::vector<JointSet> sets;
  for (;;) {
    const std::string number = std::to_string(sets.size());
    const JointSet set{attribute(primitive.attributes, "JOINTS_" + number),
                       attribute(primitive.attributes, "WEIGHTS_" + number)};
    if (set.joints < 0 || set.weights < 0) return sets;
    sets.push_back(set);
  }
}

}  // namespace

tl::expected<VertexPlacement, std::string> VertexPlacement::skinned(
    const tinygltf::Model& model, const tinygltf::Primitive& primitive,
    const std::vector<uint32_t>& vertices, const std::vector<glm::dmat4>& joints,
    uint64_t most_sets) {
  const std::vector<JointSet> sets = joint_sets(primitive);
  const size_t count = vertices.size();
  if (count > 0 && sets.size() > most_sets / count) {
    return Failure("has too many joints and weights: " + std::to_string(sets.size()) +
                   " sets for " + std::to_string(count) + " vertices");
  }
  VertexPlacement out(glm::dmat4(1.0));
  out.joints_ = &joints;
  out.influences_ = kJointsPerSet * sets.size();
  out.joint_of_.resize(count * out.influences_);
  out.weight_of_.resize(count * out.influences_);
  for (size_t set = 0; set < sets.size(); ++set) {
    if (auto read = out.read_set(model, sets[set], vertices, kJointsPerSet * set); !read) {
      return Failure(read.error());
    }
  }
  for (size_t v = 0; v < count && out.influences_ > 0; ++v) {
    const std::span<float> weights(&out.weight_of_[v * out.influences_], out.influences_);
    float sum = std::accumulate(weights.begin(), weights.end(), 0.0f);
    if (!(sum > 0.0f)) weights[0] = sum = 1.0f;
    for (float& weight : weights) weight /= sum;
  }
  return out;
}

tl::expected<void, std::string> VertexPlacement::read_set(const tinygltf::Model& model,
                                                          const JointSet& set,
                                                          const std::vector<uint32_t>& vertices,
                                                          size_t first_influence) {
  const auto joints = read_floats(model, set.joints, kJointsPerSet, 0, &vertices);
  if (!joints) return Failure(joints.error());
  const auto weights = read_floats(model, set.weights, kJointsPerSet, 0, &vertices);
  if (!weights) return Failure(weights.error());
  const auto joint_count = static_cast<float>(joints_->size());
  for (size_t i = 0; i < joints->size(); ++i) {
    const float joint = (*joints)[i];
    const float weight = std::isfinite((*weights)[i]) ? std::max((*weights)[i], 0.0f) : 0.0f;
    const bool exists = joint >= 0.0f && joint < joint_count;
    if (!exists && weight > 0.0f) {
      return Failure("has a vertex of joint " + std::to_string(joint) + ", and its skin has " +
                     std::to_string(joints_->size()) + " joints");
    }
    const size_t at = i / kJointsPerSet * influences_ + first_influence + i % kJointsPerSet;
    joint_of_[at] = exists ? static_cast<uint16_t>(joint) : uint16_t{0};
    weight_of_[at] = weight;
  }
  return {};
}

glm::dmat4 VertexPlacement::at(size_t vertex) const {
  if (joints_ == nullptr || influences_ == 0) return transform_;
  glm::dmat4 sum(0.0);
  for (size_t i = vertex * influences_; i < (vertex + 1) * influences_; ++i) {
    if (weight_of_[i] > 0.0f) sum += (*joints_)[joint_of_[i]] * static_cast<double>(weight_of_[i]);
  }
  return sum;
}

tl::expected<std::vector<glm::dmat4>, std::string> joint_matrices(
    const tinygltf::Model& model, int index, const std::vector<glm::dmat4>& placed, uint64_t most) {
  if (index < 0 || static_cast<size_t>(index) >= model.skins.size()) {
    return Failure("has no skin " + std::to_string(index));
  }
  const tinygltf::Skin& skin = model.skins[static_cast<size_t>(index)];
  const std::string name = "has skin " + std::to_string(index) + ", which ";
  constexpr size_t kMost = UINT16_MAX + size_t{1};  // JOINTS_n are 16-bit at most
  if (skin.joints.empty() || skin.joints.size() > kMost) {
    return Failure(name + "has " + std::to_string(skin.joints.size()) + " joints");
  }
  if (skin.joints.size() > most) {
    return Failure(name + "takes the scene past the number of joints that is read here");
  }
  std::optional<std::vector<float>> inverse_bind;
  if (skin.inverseBindMatrices >= 0) {
    auto read = read_floats(model, skin.inverseBindMatrices, 16, kMost);
    if (!read) return Failure(name + read.error());
    if (read->size() < 16 * skin.joints.size()) {
      return Failure(name + "has fewer inverse bind matrices than joints");
    }
    inverse_bind = std::move(*read);
  }
  std::vector<glm::dmat4> out;
  for (size_t i = 0; i < skin.joints.size(); ++i) {
    const int joint = skin.joints[i];
    if (joint < 0 || static_cast<size_t>(joint) >= placed.size()) {
      return Failure(name + "has no node " + std::to_string(joint) + " for a joint");
    }
    glm::dmat4 bind(1.0);
    for (int c = 0; inverse_bind && c < 16; ++c) {
      bind[c / 4][c % 4] = (*inverse_bind)[16 * i + static_cast<size_t>(c)];
    }
    out.push_back(placed[static_cast<size_t>(joint)] * bind);
  }
  return out;
}

glm::dmat4 local_transform(const tinygltf::Node& node) {
  if (node.matrix.size() == 16) {
    glm::dmat4 m(1.0);
    for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = node.matrix[static_cast<size_t>(i)];
    return m;
  }
  glm::dvec3 translation(0.0), scale(1.0);
  glm::dquat rotation(1.0, 0.0, 0.0, 0.0);
  if (node.rotation.size() == 4) {
    rotation = {node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]};
  }
  for (int c = 0; c < 3; ++c) {
    if (node.scale.size() == 3) scale[c] = node.scale[static_cast<size_t>(c)];
    if (node.translation.size() == 3) translation[c] = node.translation[static_cast<size_t>(c)];
  }
  return transform_of(translation, rotation, scale);
}

tl::expected<NodeInstances, std::string> NodeInstances::read(const tinygltf::Model& model,
                                                             const tinygltf::Node& node,
                                                             uint64_t most) {
  NodeInstances out;
  const auto found = node.extensions.find("EXT_mesh_gpu_instancing");
  if (found == node.extensions.end()) return out;
  struct Attribute {
    const char* name;
    int components;
    std::vector<float>& values;
  };
  std::optional<size_t> count;
  for (const Attribute& attribute :
       {Attribute{"TRANSLATION", 3, out.translations_}, Attribute{"ROTATION", 4, out.rotations_},
        Attribute{"SCALE", 3, out.scales_}}) {
    const int accessor = instance_attribute(found->second, attribute.name);
    if (accessor < 0) continue;
    auto values = read_floats(model, accessor, attribute.components, most);
    if (!values) return Failure("has instances whose " + values.error());
    const size_t elements = values->size() / static_cast<size_t>(attribute.components);
    if (count.value_or(elements) != elements) {
      return Failure("has instances whose attributes differ in number");
    }
    count = elements;
    attribute.values = std::move(*values);
  }
  out.count_ = count.value_or(0);
  return out;
}

glm::dmat4 NodeInstances::at(size_t instance) const {
  glm::dvec3 translation(0.0), scale(1.0);
  glm::dquat rotation(1.0, 0.0, 0.0, 0.0);
  for (int c = 0; c < 3; ++c) {
    const size_t at = 3 * instance + static_cast<size_t>(c);
    if (!translations_.empty()) translation[c] = translations_[at];
    if (!scales_.empty()) scale[c] = scales_[at];
  }
  if (!rotations_.empty()) {
    const float* q = &rotations_[4 * instance];
    rotation = {q[3], q[0], q[1], q[2]};
  }
  return transform_of(translation, rotation, scale);
}

}  // namespace alcove::sample
