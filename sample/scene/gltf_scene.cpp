#include "scene/gltf_scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "scene/gltf_nodes.h"
#include "scene/gltf_skin.h"

namespace alcove::sample {
namespace {

// Returns whether a transform and its inverse can be stored as floats. The instances of a mesh need
// both.
bool can_be_instance(const glm::dmat4& m) {
  double longest = 0.0;
  for (int c = 0; c < 3; ++c) longest = std::max(longest, glm::length(glm::dvec3(m[c])));
  constexpr double kFarthest = 1e12;
  const double volume = std::abs(glm::determinant(glm::dmat3(m)));
  return longest > 1e-9 && longest < 1e9 && volume > 1e-6 * longest * longest * longest &&
         glm::length(glm::dvec3(m[3])) < kFarthest;
}

// Adds the meshes and cameras of nodes to a scene.
class NodeReader {
 public:
  NodeReader(const tinygltf::Model& model, const NodeTree& nodes, GltfLimits& budget, Scene& scene)
      : model_(model), nodes_(nodes), budget_(budget), scene_(scene) {
    nodes_of_.resize(model.meshes.size());
    for (const DrawnNode& drawn : nodes.drawn) {
      const tinygltf::Node& node = model.nodes[drawn.node];
      // A node with morph weights of its own has a shape of its own.
      if (node.skin >= 0 || node.mesh < 0 || !node.weights.empty()) continue;
      nodes_of_[static_cast<size_t>(node.mesh)].push_back(&drawn);
    }
  }

  Result<void> add(const DrawnNode& drawn_node) {
    const tinygltf::Node& node = model_.nodes[drawn_node.node];
    if (node.mesh < 0) return {};
    if (node.skin >= 0) return add_skinned(node);
    if (!node.weights.empty()) return add_nodes({&drawn_node}, node);
    // The first node of a mesh adds the instances of all nodes with that mesh.
    return add_nodes(std::exchange(nodes_of_[static_cast<size_t>(node.mesh)], {}), node);
  }

 private:
  Result<void> add_nodes(const std::vector<const DrawnNode*>& nodes, const tinygltf::Node& node) {
    size_t count = 0;
    for (const DrawnNode* drawn : nodes) count += std::max<size_t>(drawn->instances.size(), 1);
    std::vector<glm::mat4x3> shared;
    std::vector<glm::dmat4> apart;
    const auto place = [&](const glm::dmat4& world) {
      if (count > 1 && can_be_instance(world))
        shared.emplace_back(world);
      else
        apart.push_back(world);
    };
    for (const DrawnNode* drawn : nodes) {
      const glm::dmat4 world = world_transform(drawn->node);
      if (drawn->instances.size() == 0) place(world);
      // Instances that coincide, such as those of attributes without data, are drawn once.
      glm::dmat4 previous(0.0);
      for (size_t i = 0; i < drawn->instances.size(); ++i) {
        const glm::dmat4 instance = drawn->instances.at(i);
        if (instance != previous) place(world * instance);
        previous = instance;
      }
    }
    for (const glm::dmat4& world : apart)
      if (auto added = add_mesh(node, PrimitivePlacement{world}); !added) return added;
    if (shared.empty()) return {};
    return add_mesh(node, PrimitivePlacement{glm::dmat4(1.0), nullptr, &shared});
  }

  glm::dmat4 world_transform(size_t node) const {
    glm::dmat4 world = nodes_.world_from_node[node];
    world[3] -= glm::dvec4(scene_.origin, 0.0);
    return world;
  }

  std::string mesh_name(const tinygltf::Node& node) const {
    const std::string& name = model_.meshes[static_cast<size_t>(node.mesh)].name;
    return !name.empty() ? "\"" + name + "\"" : std::to_string(node.mesh);
  }

  Result<void> add_skinned(const tinygltf::Node& node) {
    ALCOVE_TRY(const auto* joints,
               find_joints(node.skin).map_error(with_prefix("mesh " + mesh_name(node) + " ")));
    return add_mesh(node, PrimitivePlacement{glm::dmat4(1.0), joints});
  }

  // Returns the joint matrices of a skin relative to the scene's origin. They are computed once,
  // because many nodes may have the same skin.
  Result<const std::vector<glm::dmat4>*> find_joints(int skin) {
    const auto [known, is_new] = skin_joints_.try_emplace(skin);
    if (is_new) {
      ALCOVE_TRY(auto joints, joint_matrices(model_, skin, nodes_.world_from_node, budget_.joints));
      budget_.joints -= joints.size();
      for (glm::dmat4& joint : joints) joint[3] -= glm::dvec4(scene_.origin, 0.0);
      known->second = std::move(joints);
    }
    return &known->second;
  }

  Result<void> add_mesh(const tinygltf::Node& node, PrimitivePlacement placement) {
    const std::string name = mesh_name(node);
    const tinygltf::Mesh& mesh = model_.meshes[static_cast<size_t>(node.mesh)];
    placement.morph_weights = node.weights.empty() ? &mesh.weights : &node.weights;
    for (const auto& primitive : mesh.primitives)
      ALCOVE_TRY_VOID(add_primitive(model_, primitive, name, placement, budget_, scene_)
                          .map_error(with_prefix("mesh " + name + " ")));
    return {};
  }

  const tinygltf::Model& model_;
  const NodeTree& nodes_;
  GltfLimits& budget_;
  Scene& scene_;
  std::vector<std::vector<const DrawnNode*>> nodes_of_;  // by mesh; those not added yet
  std::map<int, std::vector<glm::dmat4>> skin_joints_;
};

}  // namespace

Result<void> add_nodes(const tinygltf::Model& model, GltfLimits& budget,
                       std::vector<PlacedCamera>& cameras, Scene& scene, const Progress& progress) {
  ALCOVE_TRY(const auto nodes, read_nodes(model, budget.instances));
  if (nodes.repeats > 0) {
    scene.warnings.push_back(
        "The scene reaches nodes again by a second parent or as a root: each is drawn once.");
  }
  scene.origin = chosen_origin(model, nodes);
  NodeReader reader(model, nodes, budget, scene);
  size_t done = 0;
  for (const DrawnNode& drawn : nodes.drawn) {
    ALCOVE_TRY_VOID(reader.add(drawn));
    if (progress) progress(double(++done) / double(nodes.drawn.size()));
    glm::dmat4 world_from_node = nodes.world_from_node[drawn.node];
    world_from_node[3] -= glm::dvec4(scene.origin, 0.0);
    add_camera(model, model.nodes[drawn.node], world_from_node, cameras, scene);
  }
  return {};
}

}  // namespace alcove::sample
