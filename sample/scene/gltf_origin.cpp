#include "scene/gltf_origin.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "scene/gltf_accessor.h"

namespace alcove::sample {
namespace {

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
