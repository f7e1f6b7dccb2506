#include "scene/tangents.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace alcove::sample {
namespace {

// Sets of the numbers below a count, which begin apart and grow together (union-find).
class DisjointSets {
 public:
  explicit DisjointSets(size_t count) : parents_(count) {
    std::iota(parents_.begin(), parents_.end(), 0u);
  }
  // Returns the number that stands for the set of a number.
  uint32_t root(uint32_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) { parents_[root(a)] = root(b); }

 private:
  std::vector<uint32_t> parents_;
};

// The orientation of a triangle in texture space.
enum class Orientation : uint8_t {
  unknown,  // its area in texture space is 0
  front,
  mirrored,  // the texture is mirrored on the triangle
};

struct FaceTangent {
  glm::dvec3 along_u{0.0};  // unit; zero if the orientation is unknown
  Orientation orientation = Orientation::unknown;
};

FaceTangent face_tangent(const std::array<glm::dvec3, 3>& corners,
                         const std::array<glm::dvec2, 3>& uvs) {
  const glm::dvec2 b = uvs[1] - uvs[0];
  const glm::dvec2 c = uvs[2] - uvs[0];
  const double area = b.x * c.y - b.y * c.x;
  if (!std::isfinite(area) || area == 0.0) return {};
  // v increases downwards in an image, so that a counter-clockwise triangle has a negative area.
  const double sign = area < 0.0 ? -1.0 : 1.0;
  const glm::dvec3 u = (corners[1] - corners[0]) * c.y - (corners[2] - corners[0]) * b.y;
  return {direction_of(sign * u), area > 0.0 ? Orientation::mirrored : Orientation::front};
}

glm::dvec3 in_plane(const glm::dvec3& v, const glm::dvec3& normal) {
  return direction_of(v - normal * glm::dot(normal, v));
}

// The values that must be equal for corners to be the same vertex in MikkTSpace.
struct CornerValues {
  glm::vec3 position;
  glm::vec3 normal;
  glm::vec2 uv;
};

// Computes the tangents of the corners of a mesh by the rules of MikkTSpace (Mikkelsen 2008,
// "Simulation of Wrinkled Surfaces Revisited", and the notes of its reference implementation).
class TangentBuilder {
 public:
  TangentBuilder(const Mesh& mesh, const TextureUse& map)
      : mesh_(mesh), vertex_of_(mesh.indices.size()), groups_(mesh.indices.size()) {
    weld(map);
    group_corners();
  }

  std::vector<glm::vec4> build();

 private:
  void weld(const TextureUse& map);
  void group_corners();
  glm::dvec3 position(size_t corner) const {
    return glm::dvec3(mesh_.positions[mesh_.indices[corner]]);
  }

  const Mesh& mesh_;
  std::vector<FaceTangent> faces_;
  // For each corner, its vertex: corners with equal values have the same vertex.
  std::vector<uint32_t> vertex_of_;
  DisjointSets groups_;  // of corners
};

uint32_t next_corner(uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
uint32_t previous_corner(uint32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }

void TangentBuilder::weld(const TextureUse& map) {
  std::vector<CornerValues> values;
  for (size_t first = 0; first + 2 < mesh_.indices.size(); first += 3) {
    std::array<glm::dvec3, 3> corners;
    std::array<glm::dvec2, 3> uvs;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t v = mesh_.indices[first + k];
      const glm::vec2 uv = texture_uv(map, uvs_at(mesh_, v));
      corners[k] = glm::dvec3(mesh_.positions[v]);
      uvs[k] = uv;
      // Adding 0 makes 0 of -0, because bytes are compared.
      values.push_back({mesh_.positions[v] + 0.0f, mesh_.normals[v] + 0.0f, uv + 0.0f});
    }
    faces_.push_back(face_tangent(corners, uvs));
  }
  meshopt_generateVertexRemap(vertex_of_.data(), nullptr, values.size(), values.data(),
                              values.size(), sizeof(CornerValues));
}

// Groups the corners of each vertex. Two corners are in one group if their triangles share an edge
// at the vertex and have the same orientation in texture space. A triangle whose orientation is
// unknown joins the first of its neighbours.
void TangentBuilder::group_corners() {
  struct Edge {
    uint64_t key;  // from one vertex to another
    uint32_t corner;
  };
  const auto key = [&](size_t from, size_t to) {
    return uint64_t{vertex_of_[from]} << 32 | vertex_of_[to];
  };
  std::vector<Edge> edges(vertex_of_.size());
  for (uint32_t i = 0; i < edges.size(); ++i) edges[i] = {key(i, next_corner(i)), i};
  const auto by_key = [](const Edge& a, const Edge& b) { return a.key < b.key; };
  std::sort(edges.begin(), edges.end(), by_key);
  for (const bool known : {true, false}) {
    for (uint32_t i = 0; i < vertex_of_.size(); ++i) {
      const auto [first, last] =
          std::equal_range(edges.begin(), edges.end(), Edge{key(next_corner(i), i), 0}, by_key);
      for (auto edge = first; edge != last; ++edge) {
        const Orientation here = faces_[i / 3].orientation;
        const Orientation there = faces_[edge->corner / 3].orientation;
        const bool alike = known ? here == there && here != Orientation::unknown
                                 : here == Orientation::unknown && there != here;
        if (!alike) continue;
        // In the neighbouring triangle the edge has the opposite direction.
        groups_.join(i, next_corner(edge->corner));
        groups_.join(next_corner(i), edge->corner);
        if (!known) break;
      }
    }
  }
}

std::vector<glm::vec4> TangentBuilder::build() {
  std::vector<glm::dvec3> sums(vertex_of_.size(), glm::dvec3(0.0));
  std::vector<float> sides(vertex_of_.size(), 1.0f);
  for (uint32_t i = 0; i < vertex_of_.size(); ++i) {
    const FaceTangent& face = faces_[i / 3];
    if (face.orientation == Orientation::unknown) continue;
    const glm::dvec3 normal(mesh_.normals[mesh_.indices[i]]);
    const glm::dvec3 a = in_plane(position(next_corner(i)) - position(i), normal);
    const glm::dvec3 b = in_plane(position(previous_corner(i)) - position(i), normal);
    const double angle = std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
    const uint32_t group = groups_.root(i);
    sums[group] += in_plane(face.along_u, normal) * angle;
    sides[group] = face.orientation == Orientation::mirrored ? -1.0f : 1.0f;
  }
  std::vector<glm::vec4> out(vertex_of_.size());
  for (uint32_t i = 0; i < out.size(); ++i) {
    const uint32_t group = groups_.root(i);
    out[i] = glm::vec4(glm::vec3(direction_of(sums[group])), sides[group]);
  }
  return out;
}

std::vector<glm::vec4> given_tangents(const Mesh& mesh) {
  std::vector<glm::vec4> out(mesh.indices.size());
  for (size_t i = 0; i < out.size(); ++i) out[i] = mesh.tangents[mesh.indices[i]];
  return out;
}

}  // namespace

std::vector<glm::vec4> corner_tangents(const Mesh& mesh, const TextureUse& map) {
  if (!mesh.tangents.empty()) return given_tangents(mesh);
  return TangentBuilder(mesh, map).build();
}

}  // namespace alcove::sample
