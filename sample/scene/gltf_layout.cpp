#include "scene/gltf_layout.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "scene/gltf_accessor.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

// Returns for each node whether it is a child of another node.
std::vector<char> children_of_nodes(const tinygltf::Model& model) {
  std::vector<char> is_child(model.nodes.size(), 0);
  for (const tinygltf::Node& node : model.nodes) {
    for (const int child : node.children) {
      if (child >= 0 && static_cast<size_t>(child) < is_child.size()) {
        is_child[static_cast<size_t>(child)] = 1;
      }
    }
  }
  return is_child;
}

// Returns the root nodes: those of the default scene, or all nodes that are not the child of
// another node.
tl::expected<std::vector<int>, std::string> root_nodes(const tinygltf::Model& model) {
  if (!model.scenes.empty()) {
    const int index = std::max(model.defaultScene, 0);
    if (static_cast<size_t>(index) >= model.scenes.size()) {
      return Failure("it has no scene " + std::to_string(index));
    }
    return model.scenes[static_cast<size_t>(index)].nodes;
  }
  const std::vector<char> is_child = children_of_nodes(model);
  std::vector<int> roots;
  for (size_t i = 0; i < is_child.size(); ++i) {
    if (!is_child[i]) roots.push_back(static_cast<int>(i));
  }
  return roots;
}

// Returns whether KHR_node_visibility hides the node. Its descendants are then hidden too.
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

  // Computes the transforms of the nodes below `roots`. If `drawn` is false, the nodes only get a
  // transform and are not drawn: joints may be outside of the drawn scene.
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
      return Failure("it names node " + std::to_string(step.node) + ", which does not exist");
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

// Returns up to eight vertices of a primitive in mesh space, evenly spaced in the file. Vertices
// that cannot be read are left out; add_primitive() reports the error later.
std::vector<glm::dvec3> some_vertices(const tinygltf::Model& model,
                                      const tinygltf::Primitive& primitive) {
  constexpr uint64_t kMost = 8;
  const int accessor = attribute(primitive.attributes, "POSITION");
  if (accessor < 0 || static_cast<size_t>(accessor) >= model.accessors.size()) return {};
  const uint64_t count = model.accessors[static_cast<size_t>(accessor)].count;
  std::vector<uint32_t> chosen;
  for (uint64_t i = 0; i < std::min(count, kMost); ++i) {
    chosen.push_back(static_cast<uint32_t>(count <= kMost ? i : i * ((count - 1) / (kMost - 1))));
  }
  const auto values = read_floats(model, accessor, 3, 0, &chosen);
  std::vector<glm::dvec3> out;
  for (size_t i = 0; values && i + 2 < values->size(); i += 3) {
    out.emplace_back((*values)[i], (*values)[i + 1], (*values)[i + 2]);
  }
  return out;
}

// Returns the transform from the mesh of a drawn node to the space of the file. For several
// instances it is that of the middle one, for a skin that of its first joint. Returns null if the
// file names a node that does not exist.
std::optional<glm::dmat4> placement_of(const tinygltf::Model& model, const Layout& layout,
                                       const DrawnNode& drawn) {
  const tinygltf::Node& node = model.nodes[drawn.node];
  if (node.skin >= 0 && static_cast<size_t>(node.skin) < model.skins.size() &&
      !model.skins[static_cast<size_t>(node.skin)].joints.empty()) {
    const int joint = model.skins[static_cast<size_t>(node.skin)].joints.front();
    if (joint < 0 || static_cast<size_t>(joint) >= model.nodes.size()) return std::nullopt;
    return layout.world_from_node[static_cast<size_t>(joint)];
  }
  const glm::dmat4& world = layout.world_from_node[drawn.node];
  if (drawn.instances.size() == 0) return world;
  return world * drawn.instances.at(drawn.instances.size() / 2);
}

// Returns some vertices of the primitives of all drawn nodes in the space of the file.
std::vector<glm::dvec3> placed_vertices(const tinygltf::Model& model, const Layout& layout) {
  constexpr size_t kMost = 1'000'000;
  std::map<const tinygltf::Primitive*, std::vector<glm::dvec3>> known;
  std::vector<glm::dvec3> out;
  for (const DrawnNode& drawn : layout.drawn) {
    const int mesh = model.nodes[drawn.node].mesh;
    if (mesh < 0 || static_cast<size_t>(mesh) >= model.meshes.size()) continue;
    const auto placed = placement_of(model, layout, drawn);
    if (!placed) continue;
    for (const auto& primitive : model.meshes[static_cast<size_t>(mesh)].primitives) {
      if (out.size() >= kMost) return out;
      const auto [vertices, is_new] = known.try_emplace(&primitive);
      if (is_new) vertices->second = some_vertices(model, primitive);
      for (const glm::dvec3& vertex : vertices->second) {
        const glm::dvec3 at(*placed * glm::dvec4(vertex, 1.0));
        if (std::isfinite(glm::length(at))) out.push_back(at);
      }
    }
  }
  return out;
}

// Returns the value that the fraction `share` of the values does not exceed. `values` must not be
// empty.
double quantile(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}

}  // namespace

tl::expected<Layout, std::string> place_nodes(const tinygltf::Model& model,
                                              uint64_t most_instances) {
  const auto roots = root_nodes(model);
  if (!roots) return Failure(roots.error());
  Layout layout;
  TreeWalk walk(model, layout);
  if (auto done = walk.walk(*roots, true); !done) return Failure(done.error());
  const std::vector<char> is_child = children_of_nodes(model);
  for (size_t i = 0; i < is_child.size(); ++i) {
    if (is_child[i] || walk.is_visited(i)) continue;
    if (auto done = walk.walk({static_cast<int>(i)}, false); !done) return Failure(done.error());
  }
  for (size_t i = 0; i < is_child.size(); ++i) {
    if (!walk.is_visited(i)) {
      return Failure("node " + std::to_string(i) +
                     " is in a cycle of nodes, which no root reaches");
    }
  }
  for (DrawnNode& drawn : layout.drawn) {
    const tinygltf::Node& node = model.nodes[drawn.node];
    if (node.mesh < 0 || node.skin >= 0) continue;
    auto instances = NodeInstances::read(model, node, most_instances);
    if (!instances) return Failure("node \"" + node.name + "\" " + instances.error());
    most_instances -= instances->size();
    drawn.instances = std::move(*instances);
  }
  return layout;
}

glm::dvec3 chosen_origin(const tinygltf::Model& model, const Layout& layout) {
  constexpr double kFarthest = 256.0;  // in sizes of the scene
  constexpr double kMostShift = 1e15;  // as positions
  const std::vector<glm::dvec3> vertices = placed_vertices(model, layout);
  if (vertices.empty()) return glm::dvec3(0.0);
  const auto values = [&](const auto& value) {
    std::vector<double> out(vertices.size());
    std::ranges::transform(vertices, out.begin(), value);
    return out;
  };
  glm::dvec3 centre(0.0);
  for (int c = 0; c < 3; ++c) {
    centre[c] = quantile(values([c](const glm::dvec3& at) { return at[c]; }), 0.5);
  }
  const double size =
      quantile(values([&](const glm::dvec3& at) { return glm::distance(at, centre); }), 0.75);
  const double away = glm::length(centre);
  if (!(away > kFarthest * size) || !(size > 0.0) || away > kMostShift) return glm::dvec3(0.0);
  // Whole units are used if they are precise enough, so that printed positions have few digits.
  return size > 1.0 ? glm::round(centre) : centre;
}

}  // namespace alcove::sample
