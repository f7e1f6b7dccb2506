#include "scene/gltf_nodes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <map>
#include <optional>
#include <utility>

#include "scene/gltf_accessor.h"
#include "support/median.h"

namespace alcove::sample {
namespace {

constexpr const char* kCycle = "some of its nodes form a cycle; export it again";

// Returns the transform of a translation, a rotation and a scale; null: none.
template <class Number>
glm::dmat4 compose(const Number* translation, const Number* rotation, const Number* scale) {
  glm::dmat4 m(1.0);
  if (rotation != nullptr) {
    const glm::dquat q(rotation[3], rotation[0], rotation[1], rotation[2]);
    if (const double length = glm::length(q); length > 0.0) m = glm::mat4_cast(q / length);
  }
  for (int c = 0; c < 3; ++c) {
    if (scale != nullptr) m[c] *= static_cast<double>(scale[c]);
    if (translation != nullptr) m[3][c] = translation[c];
  }
  return m;
}

// Returns a node's transform to its parent, from its matrix or from its translation, rotation and
// scale.
glm::dmat4 local_transform(const tinygltf::Node& node) {
  if (!node.matrix.empty()) return glm::make_mat4(node.matrix.data());
  const auto first = [](const auto& values) { return values.empty() ? nullptr : values.data(); };
  return compose(first(node.translation), first(node.rotation), first(node.scale));
}

// Returns whether KHR_node_visibility hides the node. Its descendants are then hidden too.
bool is_hidden(const tinygltf::Node& node) {
  const auto found = node.extensions.find("KHR_node_visibility");
  return found != node.extensions.end() && found->second.Has("visible") &&
         !found->second.Get("visible").Get<bool>();
}

// The nodes at which the tree is entered: first those that are drawn, then those without a parent,
// because joints may need their transforms.
struct Roots {
  std::vector<int> nodes;
  size_t drawn;  // how many of them
};

Result<Roots> find_roots(const tinygltf::Model& model) {
  const auto count = static_cast<int>(model.nodes.size());
  const auto check = [&](const std::vector<int>& nodes) -> Result<void> {
    for (const int node : nodes)
      if (node >= count)
        return Failure("it names node " + std::to_string(node) + ", which does not exist");
    return {};
  };
  Roots out{{}, 0};
  if (!model.scenes.empty()) {
    const auto index = static_cast<size_t>(std::max(model.defaultScene, 0));
    if (index >= model.scenes.size()) return Failure("it has no scene " + std::to_string(index));
    out.nodes = model.scenes[index].nodes;
    ALCOVE_TRY_VOID(check(out.nodes));
  }
  out.drawn = out.nodes.size();
  std::vector<char> has_parent(model.nodes.size(), 0);
  for (const tinygltf::Node& node : model.nodes) {
    ALCOVE_TRY_VOID(check(node.children));
    for (const int child : node.children) has_parent[static_cast<size_t>(child)] = 1;
  }
  for (int node = 0; node < count; ++node)
    if (has_parent[static_cast<size_t>(node)] == 0) out.nodes.push_back(node);
  if (model.scenes.empty()) out.drawn = out.nodes.size();
  return out;
}

// Checks that the mesh of a node exists, and its skin with all joints, which must be `placed`.
Result<void> check_references(const tinygltf::Model& model, const tinygltf::Node& node,
                              const std::vector<char>& placed) {
  const auto refuse = [&](const std::string& what, int index) {
    return Failure("node \"" + node.name + "\" has no " + what + " " + std::to_string(index));
  };
  const auto exists = [](int index, const auto& elements) {
    return index < 0 || static_cast<size_t>(index) < elements.size();
  };
  if (node.mesh < 0) return {};
  if (!exists(node.mesh, model.meshes)) return refuse("mesh", node.mesh);
  if (!exists(node.skin, model.skins)) return refuse("skin", node.skin);
  if (node.skin < 0) return {};
  for (const int joint : model.skins[static_cast<size_t>(node.skin)].joints) {
    if (!exists(joint, model.nodes)) return refuse("joint", joint);
    if (placed[static_cast<size_t>(joint)] == 0) return Failure(kCycle);
  }
  return {};
}

// Returns up to eight vertices of a primitive in mesh space, evenly spaced in the file. Vertices
// that cannot be read are left out; add_primitive() reports the error later.
std::vector<glm::dvec3> some_vertices(const tinygltf::Model& model,
                                      const tinygltf::Primitive& primitive) {
  constexpr uint64_t kMost = 8;
  const int accessor = attribute(primitive.attributes, "POSITION");
  if (accessor < 0 || static_cast<size_t>(accessor) >= model.accessors.size()) return {};
  const uint64_t count = model.accessors[static_cast<size_t>(accessor)].count;
  std::vector<uint32_t> chosen;
  for (uint64_t i = 0; i < std::min(count, kMost); ++i)
    chosen.push_back(static_cast<uint32_t>(count <= kMost ? i : i * ((count - 1) / (kMost - 1))));
  const auto values = read_floats(model, accessor, 3, 0, &chosen);
  std::vector<glm::dvec3> out;
  for (size_t i = 0; values && i + 2 < values->size(); i += 3)
    out.emplace_back((*values)[i], (*values)[i + 1], (*values)[i + 2]);
  return out;
}

// Returns some vertices of the primitives of all drawn nodes in the space of the file. Of several
// instances the middle one counts, and of a skin the first joint.
std::vector<glm::dvec3> placed_vertices(const tinygltf::Model& model, const NodeTree& nodes) {
  constexpr size_t kMost = 1'000'000;
  std::map<const tinygltf::Primitive*, std::vector<glm::dvec3>> known;
  std::vector<glm::dvec3> out;
  for (const DrawnNode& drawn : nodes.drawn) {
    const tinygltf::Node& node = model.nodes[drawn.node];
    if (node.mesh < 0) continue;
    size_t placed_by = drawn.node;
    if (node.skin >= 0) {
      const auto& joints = model.skins[static_cast<size_t>(node.skin)].joints;
      if (!joints.empty()) placed_by = static_cast<size_t>(joints.front());
    }
    glm::dmat4 world = nodes.world_from_node[placed_by];
    if (drawn.instances.size() > 0) world *= drawn.instances.at(drawn.instances.size() / 2);
    for (const auto& primitive : model.meshes[static_cast<size_t>(node.mesh)].primitives) {
      if (out.size() >= kMost) return out;
      const auto [vertices, is_new] = known.try_emplace(&primitive);
      if (is_new) vertices->second = some_vertices(model, primitive);
      for (const glm::dvec3& vertex : vertices->second) {
        const glm::dvec3 at(world * glm::dvec4(vertex, 1.0));
        if (std::isfinite(glm::length(at))) out.push_back(at);
      }
    }
  }
  return out;
}

}  // namespace

Result<NodeTree> read_nodes(const tinygltf::Model& model, uint64_t most_instances) {
  ALCOVE_TRY(const auto roots, find_roots(model));
  struct Step {
    int node;
    glm::dmat4 world_from_parent;
    bool drawn;
  };
  std::vector<Step> open;  // a stack: the last one is visited next
  for (size_t i = roots.nodes.size(); i-- > 0;)
    open.push_back({roots.nodes[i], glm::dmat4(1.0), i < roots.drawn});
  NodeTree out;
  out.world_from_node.assign(model.nodes.size(), glm::dmat4(1.0));
  std::vector<char> visited(model.nodes.size(), 0);
  while (!open.empty()) {
    const Step step = open.back();
    open.pop_back();
    const auto index = static_cast<size_t>(step.node);
    if (std::exchange(visited[index], 1) != 0) {
      out.repeats += step.drawn ? 1 : 0;
      continue;
    }
    const tinygltf::Node& node = model.nodes[index];
    const glm::dmat4 world = step.world_from_parent * local_transform(node);
    out.world_from_node[index] = world;
    const bool drawn = step.drawn && !is_hidden(node);
    if (drawn) out.drawn.push_back({index, {}});
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
      open.push_back({*child, world, drawn});
  }
  // Without scenes, all nodes are drawn. Otherwise a cycle may stand outside of the scene.
  if (model.scenes.empty() && std::ranges::find(visited, 0) != visited.end())
    return Failure(kCycle);
  for (DrawnNode& drawn : out.drawn) {
    const tinygltf::Node& node = model.nodes[drawn.node];
    ALCOVE_TRY_VOID(check_references(model, node, visited));
    if (node.mesh < 0 || node.skin >= 0) continue;
    ALCOVE_TRY(drawn.instances, NodeInstances::read(model, node, most_instances)
                                    .map_error(with_prefix("node \"" + node.name + "\" ")));
    most_instances -= drawn.instances.size();
  }
  return out;
}

glm::dvec3 chosen_origin(const tinygltf::Model& model, const NodeTree& nodes) {
  constexpr double kFarthest = 256.0;  // in sizes of the scene
  constexpr double kMostShift = 1e15;  // as positions
  const std::vector<glm::dvec3> vertices = placed_vertices(model, nodes);
  if (vertices.empty()) return glm::dvec3(0.0);
  const auto quantile = [&](double share, const auto& value) {
    std::vector<double> values(vertices.size());
    std::ranges::transform(vertices, values.begin(), value);
    return percentile(std::move(values), share);
  };
  glm::dvec3 centre(0.0);
  for (int c = 0; c < 3; ++c)
    centre[c] = quantile(0.5, [c](const glm::dvec3& at) { return at[c]; });
  const double size =
      quantile(0.75, [&](const glm::dvec3& at) { return glm::distance(at, centre); });
  const double away = glm::length(centre);
  if (!(away > kFarthest * size) || !(size > 0.0) || away > kMostShift) return glm::dvec3(0.0);
  // Whole units are used if they are precise enough, so that printed positions have few digits.
  return size > 1.0 ? glm::round(centre) : centre;
}

Result<NodeInstances> NodeInstances::read(const tinygltf::Model& model, const tinygltf::Node& node,
                                          uint64_t most) {
  NodeInstances out;
  const auto found = node.extensions.find("EXT_mesh_gpu_instancing");
  if (found == node.extensions.end()) return out;
  const tinygltf::Value& accessors = found->second.Get("attributes");
  struct Attribute {
    const char* name;
    int components;
    std::vector<float>& values;
  };
  std::optional<size_t> count;
  for (const Attribute& attribute :
       {Attribute{"TRANSLATION", 3, out.translations_}, Attribute{"ROTATION", 4, out.rotations_},
        Attribute{"SCALE", 3, out.scales_}}) {
    if (!accessors.Has(attribute.name)) continue;
    ALCOVE_TRY(attribute.values, read_floats(model, accessors.Get(attribute.name).GetNumberAsInt(),
                                             attribute.components, most)
                                     .map_error(with_prefix("has instances whose ")));
    const size_t elements = attribute.values.size() / static_cast<size_t>(attribute.components);
    if (count.value_or(elements) != elements)
      return Failure("has instances whose attributes differ in number");
    count = elements;
  }
  out.count_ = count.value_or(0);
  return out;
}

glm::dmat4 NodeInstances::at(size_t instance) const {
  const auto of_instance = [&](const std::vector<float>& values, size_t components) {
    return values.empty() ? nullptr : &values[components * instance];
  };
  return compose(of_instance(translations_, 3), of_instance(rotations_, 4),
                 of_instance(scales_, 3));
}

}  // namespace alcove::sample
