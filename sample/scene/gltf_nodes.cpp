#include "scene/gltf_nodes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "scene/gltf_accessor.h"
#include "scene/gltf_placement.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

// A node that is drawn, with the instances that it adds to its own transform.
struct DrawnNode {
  size_t node;
  NodeInstances instances;  // empty: the node itself
};

// Where everything of a file stands.
struct Layout {
  std::vector<glm::dmat4> world_from_node;  // by node
  std::vector<DrawnNode> drawn;             // in the order of the tree
};

// The nodes to start from: those of the default scene, or every node that is nobody's child.
tl::expected<std::vector<int>, std::string> root_nodes(const tinygltf::Model& model) {
  if (!model.scenes.empty()) {
    const int index = std::max(model.defaultScene, 0);
    if (static_cast<size_t>(index) >= model.scenes.size()) {
      return Failure("it has no scene " + std::to_string(index));
    }
    return model.scenes[static_cast<size_t>(index)].nodes;
  }
  std::vector<char> is_child(model.nodes.size(), 0);
  for (const tinygltf::Node& node : model.nodes) {
    for (const int child : node.children) {
      if (child >= 0 && static_cast<size_t>(child) < is_child.size()) {
        is_child[static_cast<size_t>(child)] = 1;
      }
    }
  }
  std::vector<int> roots;
  for (size_t i = 0; i < is_child.size(); ++i) {
    if (!is_child[i]) roots.push_back(static_cast<int>(i));
  }
  return roots;
}

// KHR_node_visibility hides a node and all below it.
bool is_hidden(const tinygltf::Node& node) {
  const auto found = node.extensions.find("KHR_node_visibility");
  if (found == node.extensions.end() || !found->second.Has("visible")) return false;
  const tinygltf::Value& visible = found->second.Get("visible");
  return visible.IsBool() && !visible.Get<bool>();
}

// Visits every node once, from the roots; a second visit means a cycle or two parents.
class TreeWalk {
 public:
  TreeWalk(const tinygltf::Model& model, Layout& layout)
      : model_(model), layout_(layout), visited_(model.nodes.size(), 0) {
    layout.world_from_node.assign(model.nodes.size(), glm::dmat4(1.0));
  }

  // Nodes that are not `drawn` are placed alone: joints may stand outside of the scene.
  tl::expected<void, std::string> walk(const std::vector<int>& roots, bool drawn) {
    std::vector<Step> open;
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) {
      open.push_back({*root, glm::dmat4(1.0), drawn});
    }
    while (!open.empty()) {
      const Step step = open.back();
      open.pop_back();
      if (auto done = visit(step, open); !done) return done;
    }
    return {};
  }

  bool is_visited(size_t node) const { return visited_[node] != 0; }

 private:
  struct Step {
    int node;
    glm::dmat4 world_from_parent;
    bool drawn;
  };

  tl::expected<void, std::string> visit(const Step& step, std::vector<Step>& open) {
    if (step.node < 0 || static_cast<size_t>(step.node) >= model_.nodes.size()) {
      return Failure("it has no node " + std::to_string(step.node));
    }
    const auto index = static_cast<size_t>(step.node);
    if (std::exchange(visited_[index], 1)) {
      return Failure("node " + std::to_string(index) +
                     " is reached twice: nodes form a cycle or have two parents");
    }
    const tinygltf::Node& node = model_.nodes[index];
    const glm::dmat4 world_from_node = step.world_from_parent * local_transform(node);
    layout_.world_from_node[index] = world_from_node;
    const bool drawn = step.drawn && !is_hidden(node);
    if (drawn) layout_.drawn.push_back({index, {}});
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
      open.push_back({*child, world_from_node, drawn});
    }
    return {};
  }

  const tinygltf::Model& model_;
  Layout& layout_;
  std::vector<char> visited_;
};

tl::expected<Layout, std::string> place_nodes(const tinygltf::Model& model, MeshBudget& budget) {
  const auto roots = root_nodes(model);
  if (!roots) return Failure(roots.error());
  Layout layout;
  TreeWalk walk(model, layout);
  if (auto done = walk.walk(*roots, true); !done) return Failure(done.error());
  std::vector<char> is_child(model.nodes.size(), 0);
  for (const tinygltf::Node& node : model.nodes) {
    for (const int child : node.children) {
      if (child >= 0 && static_cast<size_t>(child) < is_child.size()) {
        is_child[static_cast<size_t>(child)] = 1;
      }
    }
  }
  for (size_t i = 0; i < is_child.size(); ++i) {
    if (is_child[i] || walk.is_visited(i)) continue;
    if (auto done = walk.walk({static_cast<int>(i)}, false); !done) return Failure(done.error());
  }
  for (DrawnNode& drawn : layout.drawn) {
    const tinygltf::Node& node = model.nodes[drawn.node];
    if (node.mesh < 0 || node.skin >= 0) continue;
    auto instances = NodeInstances::read(model, node, budget.instances);
    if (!instances) return Failure("node \"" + node.name + "\" " + instances.error());
    budget.instances -= instances->size();
    drawn.instances = std::move(*instances);
  }
  return layout;
}

// The middle of a primitive in mesh space, and half the diagonal of its bounds.
struct PrimitiveExtent {
  glm::dvec3 middle{0.0};
  double reach = 0.0;
};

// Reads the positions; zero where they cannot be read, which add_primitive() reports.
PrimitiveExtent extent_of(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                          uint64_t most) {
  const auto position = primitive.attributes.find("POSITION");
  if (position == primitive.attributes.end()) return {};
  const auto values = read_floats(model, position->second, 3, most);
  if (!values || values->empty()) return {};
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (size_t i = 0; i + 2 < values->size(); i += 3) {
    const glm::dvec3 at((*values)[i], (*values)[i + 1], (*values)[i + 2]);
    low = glm::min(low, at);
    high = glm::max(high, at);
  }
  const PrimitiveExtent out{0.5 * (low + high), 0.5 * glm::length(high - low)};
  const bool finite = std::isfinite(out.reach) && std::isfinite(glm::length(out.middle));
  return finite ? out : PrimitiveExtent{};
}

double middle_of(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}

// The origin of world space in that of the file: zero, or for a scene further from it than 256
// times its own size a point in its middle. At that distance floats round to 2^-16 of the size.
// Medians, so that a few parts elsewhere change nothing.
glm::dvec3 chosen_origin(const tinygltf::Model& model, const Layout& layout,
                         uint64_t most_vertices) {
  constexpr double kFarthest = 256.0;                                      // in sizes of the scene
  std::vector<std::vector<PrimitiveExtent>> extents(model.meshes.size());  // those read so far
  std::vector<glm::dvec3> middles;
  std::vector<double> reaches;
  for (const DrawnNode& drawn : layout.drawn) {
    const tinygltf::Node& node = model.nodes[drawn.node];
    if (node.mesh < 0 || static_cast<size_t>(node.mesh) >= model.meshes.size()) continue;
    glm::dmat4 placed = layout.world_from_node[drawn.node];
    if (drawn.instances.size() > 0) placed *= drawn.instances.at(drawn.instances.size() / 2);
    if (node.skin >= 0 && static_cast<size_t>(node.skin) < model.skins.size() &&
        !model.skins[static_cast<size_t>(node.skin)].joints.empty()) {
      const int joint = model.skins[static_cast<size_t>(node.skin)].joints.front();
      if (joint < 0 || static_cast<size_t>(joint) >= model.nodes.size()) continue;
      placed = layout.world_from_node[static_cast<size_t>(joint)];
    }
    const auto mesh = static_cast<size_t>(node.mesh);
    if (extents[mesh].empty()) {
      for (const auto& primitive : model.meshes[mesh].primitives) {
        extents[mesh].push_back(extent_of(model, primitive, most_vertices));
      }
    }
    for (const PrimitiveExtent& bounds : extents[mesh]) {
      const glm::dvec3 middle(placed * glm::dvec4(bounds.middle, 1.0));
      const double scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(placed))));
      if (!std::isfinite(glm::length(middle)) || !std::isfinite(scale)) continue;
      middles.push_back(middle);
      reaches.push_back(bounds.reach * scale);
    }
  }
  if (middles.empty()) return glm::dvec3(0.0);
  glm::dvec3 centre(0.0);
  for (int c = 0; c < 3; ++c) {
    std::vector<double> values;
    for (const glm::dvec3& middle : middles) values.push_back(middle[c]);
    centre[c] = middle_of(std::move(values), 0.5);
  }
  std::vector<double> distances;
  for (size_t i = 0; i < middles.size(); ++i) {
    distances.push_back(glm::distance(middles[i], centre) + reaches[i]);
  }
  const double size = middle_of(std::move(distances), 0.75);
  const double away = glm::length(centre);
  constexpr double kMostShift = 1e15;  // as positions
  if (!(away > kFarthest * size) || !(size > 0.0) || away > kMostShift) return glm::dvec3(0.0);
  // Whole units where that is fine enough, so that a printed view has few digits.
  return size > 1.0 ? glm::round(centre) : centre;
}

// Whether an instance of a mesh can be placed by a matrix of floats and traced by its inverse.
bool can_be_instance(const glm::dmat4& m) {
  double longest = 0.0;
  for (int c = 0; c < 3; ++c) longest = std::max(longest, glm::length(glm::dvec3(m[c])));
  constexpr double kFarthest = 1e12;
  const double volume = std::abs(glm::determinant(glm::dmat3(m)));
  return longest > 1e-9 && longest < 1e9 && volume > 1e-6 * longest * longest * longest &&
         glm::length(glm::dvec3(m[3])) < kFarthest;
}

// Adds what nodes have to a scene.
class NodeReader {
 public:
  NodeReader(const tinygltf::Model& model, const Layout& layout, MeshBudget& budget, Scene& scene)
      : model_(model), layout_(layout), budget_(budget), scene_(scene) {
    nodes_of_.resize(model.meshes.size());
    for (const DrawnNode& drawn : layout.drawn) {
      const tinygltf::Node& node = model.nodes[drawn.node];
      if (node.skin >= 0 || node.mesh < 0) continue;
      if (static_cast<size_t>(node.mesh) >= model.meshes.size()) continue;
      nodes_of_[static_cast<size_t>(node.mesh)].push_back(&drawn);
    }
  }

  tl::expected<void, std::string> add(size_t index) {
    const tinygltf::Node& node = model_.nodes[index];
    if (node.mesh < 0) return {};
    if (static_cast<size_t>(node.mesh) >= model_.meshes.size()) {
      return Failure("node \"" + node.name + "\" has no mesh " + std::to_string(node.mesh));
    }
    if (node.skin >= 0) return add_skinned(node);
    // The first node of a mesh adds all of its instances.
    const auto nodes = std::exchange(nodes_of_[static_cast<size_t>(node.mesh)], {});
    size_t count = 0;
    for (const DrawnNode* drawn : nodes) count += std::max<size_t>(drawn->instances.size(), 1);
    std::vector<glm::mat4x3> shared;
    std::vector<glm::dmat4> apart;
    if (count > 1) shared.reserve(count);
    const auto place = [&](const glm::dmat4& world) {
      if (count > 1 && can_be_instance(world)) {
        shared.emplace_back(world);
      } else {
        apart.push_back(world);
      }
    };
    for (const DrawnNode* drawn : nodes) {
      const glm::dmat4 world = world_of(drawn->node);
      if (drawn->instances.size() == 0) place(world);
      for (size_t i = 0; i < drawn->instances.size(); ++i) place(world * drawn->instances.at(i));
    }
    for (const glm::dmat4& world : apart) {
      if (auto added = add_mesh(node, PrimitivePlacement{world}); !added) return added;
    }
    if (shared.empty()) return {};
    return add_mesh(node, PrimitivePlacement{glm::dmat4(1.0), nullptr, &shared});
  }

 private:
  glm::dmat4 world_of(size_t node) const {
    glm::dmat4 world = layout_.world_from_node[node];
    world[3] -= glm::dvec4(scene_.origin, 0.0);
    return world;
  }

  std::string name_of(const tinygltf::Node& node) const {
    const std::string& name = model_.meshes[static_cast<size_t>(node.mesh)].name;
    return !name.empty() ? "\"" + name + "\"" : std::to_string(node.mesh);
  }

  tl::expected<void, std::string> add_skinned(const tinygltf::Node& node) {
    auto joints = joint_matrices(model_, node.skin, layout_.world_from_node);
    if (!joints) return Failure("mesh " + name_of(node) + " " + joints.error());
    for (glm::dmat4& joint : *joints) joint[3] -= glm::dvec4(scene_.origin, 0.0);
    return add_mesh(node, PrimitivePlacement{glm::dmat4(1.0), &*joints});
  }

  tl::expected<void, std::string> add_mesh(const tinygltf::Node& node,
                                           const PrimitivePlacement& placement) {
    const std::string name = name_of(node);
    for (const auto& primitive : model_.meshes[static_cast<size_t>(node.mesh)].primitives) {
      if (!primitive.targets.empty()) {
        scene_.warnings.push_back("Mesh " + name + " has morph targets, which are left out.");
      }
      auto added = add_primitive(model_, primitive, name, placement, budget_, scene_);
      if (!added) return added;
    }
    return {};
  }

  const tinygltf::Model& model_;
  const Layout& layout_;
  MeshBudget& budget_;
  Scene& scene_;
  std::vector<std::vector<const DrawnNode*>> nodes_of_;  // by mesh; those not added yet
};

}  // namespace

tl::expected<void, std::string> add_nodes(const tinygltf::Model& model, MeshBudget& budget,
                                          std::vector<PlacedCamera>& cameras, Scene& scene,
                                          const Progress& progress) {
  const auto layout = place_nodes(model, budget);
  if (!layout) return Failure(layout.error());
  scene.origin = chosen_origin(model, *layout, budget.vertices);
  NodeReader reader(model, *layout, budget, scene);
  size_t done = 0;
  for (const DrawnNode& drawn : layout->drawn) {
    if (auto added = reader.add(drawn.node); !added) return added;
    if (progress) progress(double(++done) / double(layout->drawn.size()));
    glm::dmat4 world_from_node = layout->world_from_node[drawn.node];
    world_from_node[3] -= glm::dvec4(scene.origin, 0.0);
    add_camera(model, model.nodes[drawn.node], world_from_node, cameras, scene);
  }
  return {};
}

}  // namespace alcove::sample
