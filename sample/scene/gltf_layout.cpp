#include "scene/gltf_layout.h"

#include <algorithm>
#include <utility>

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

}  // namespace alcove::sample
