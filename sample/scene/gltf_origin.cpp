#include "scene/gltf_origin.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "scene/gltf_accessor.h"

namespace alcove::sample {
namespace {

// The bounding sphere of the box of a primitive, in mesh space.
struct Extent {
  glm::dvec3 centre{0.0};
  double radius = 0.0;
};

// Reads the bounding spheres of primitives. Each accessor is read only once.
class ExtentReader {
 public:
  ExtentReader(const tinygltf::Model& model, uint64_t most_vertices)
      : model_(model), vertices_left_(most_vertices) {}

  // Returns null if the positions cannot be read. add_primitive() reports that error later.
  std::optional<Extent> extent_of(const tinygltf::Primitive& primitive) {
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end()) return std::nullopt;
    const auto [known, is_new] = extents_.try_emplace(position->second);
    if (is_new) known->second = read(position->second);
    return known->second;
  }

 private:
  std::optional<Extent> read(int accessor) {
    const auto values = read_floats(model_, accessor, 3, vertices_left_);
    if (!values || values->empty()) return std::nullopt;
    vertices_left_ -= values->size() / 3;
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (size_t i = 0; i + 2 < values->size(); i += 3) {
      const glm::dvec3 at((*values)[i], (*values)[i + 1], (*values)[i + 2]);
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
    const Extent out{0.5 * (low + high), 0.5 * glm::length(high - low)};
    if (!std::isfinite(out.radius) || !std::isfinite(glm::length(out.centre))) return std::nullopt;
    return out;
  }

  const tinygltf::Model& model_;
  uint64_t vertices_left_;
  std::map<int, std::optional<Extent>> extents_;  // by accessor
};

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

// Returns the bounding spheres of the primitives of all drawn nodes in the space of the file, at
// most a million.
std::vector<Extent> placed_extents(const tinygltf::Model& model, const Layout& layout,
                                   uint64_t most_vertices) {
  constexpr size_t kMost = 1'000'000;
  ExtentReader reader(model, most_vertices);
  std::vector<Extent> out;
  for (const DrawnNode& drawn : layout.drawn) {
    const int mesh = model.nodes[drawn.node].mesh;
    if (mesh < 0 || static_cast<size_t>(mesh) >= model.meshes.size()) continue;
    const auto placed = placement_of(model, layout, drawn);
    if (!placed) continue;
    const double scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(*placed))));
    for (const auto& primitive : model.meshes[static_cast<size_t>(mesh)].primitives) {
      if (out.size() == kMost) return out;
      const auto extent = reader.extent_of(primitive);
      if (!extent) continue;
      const glm::dvec3 centre(*placed * glm::dvec4(extent->centre, 1.0));
      if (!std::isfinite(glm::length(centre)) || !std::isfinite(scale)) continue;
      out.push_back({centre, extent->radius * scale});
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

glm::dvec3 chosen_origin(const tinygltf::Model& model, const Layout& layout,
                         uint64_t most_vertices) {
  constexpr double kFarthest = 256.0;  // in sizes of the scene
  constexpr double kMostShift = 1e15;  // as positions
  const std::vector<Extent> extents = placed_extents(model, layout, most_vertices);
  if (extents.empty()) return glm::dvec3(0.0);
  glm::dvec3 centre(0.0);
  for (int c = 0; c < 3; ++c) {
    std::vector<double> values;
    values.reserve(extents.size());
    for (const Extent& extent : extents) values.push_back(extent.centre[c]);
    centre[c] = quantile(std::move(values), 0.5);
  }
  std::vector<double> distances;
  distances.reserve(extents.size());
  for (const Extent& extent : extents) {
    distances.push_back(glm::distance(extent.centre, centre) + extent.radius);
  }
  const double size = quantile(std::move(distances), 0.75);
  const double away = glm::length(centre);
  if (!(away > kFarthest * size) || !(size > 0.0) || away > kMostShift) return glm::dvec3(0.0);
  // Whole units are used if they are precise enough, so that printed positions have few digits.
  return size > 1.0 ? glm::round(centre) : centre;
}

}  // namespace alcove::sample
