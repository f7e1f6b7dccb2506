#include "scene/subject.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "scene/scene.h"
#include "support/disjoint_sets.h"

namespace alcove::sample {
namespace {

constexpr size_t kMostGrouped = size_t{1} << 16;  // parts; of more parts a sample is grouped

glm::dvec3 middle(const Bounds& bounds) {
  return 0.5 * (glm::dvec3(bounds.low) + glm::dvec3(bounds.high));
}

struct Part {
  Bounds bounds_ws = empty_bounds();
  double area = 0.0;
  uint64_t triangles = 0;
};

// A triangle in world space. Its normal is that of its front, multiplied by twice its area.
struct WorldTriangle {
  std::array<glm::dvec3, 3> corners;
  glm::dvec3 normal;
  bool double_sided;
};

// Joins vertices whose coordinates differ by a few units in the last place.
void join_touching(const std::vector<glm::vec3>& positions, DisjointSets& sets) {
  std::vector<glm::uvec3> rounded;
  rounded.reserve(positions.size());
  for (const glm::vec3& p : positions)
    rounded.push_back((glm::floatBitsToUint(p + 0.0f) + 8u) & ~15u);  // -0 becomes 0
  std::vector<uint32_t> remap(positions.size()), first(positions.size(), UINT32_MAX);
  meshopt_generateVertexRemap(remap.data(), nullptr, rounded.size(), rounded.data(), rounded.size(),
                              sizeof(glm::uvec3));
  for (uint32_t v = 0; v < remap.size(); ++v) {
    uint32_t& twin = first[remap[v]];
    if (twin == UINT32_MAX) twin = v;
    sets.join(v, twin);
  }
}

// The parts of a scene, and its triangles by part.
class Parts {
 public:
  explicit Parts(const Scene& scene) : scene_(scene), instances_(instances_of(scene.meshes)) {
    uint64_t vertices = 0;
    for (const MeshInstance& instance : instances_) {
      first_vertices_.push_back(static_cast<uint32_t>(vertices));
      vertices += mesh_of(instance).positions.size();
      if (vertices > kMostVertices) break;
    }
    if (vertices > kMostVertices)
      take_instances();
    else
      connect(vertices);
  }

  const std::vector<Part>& all() const { return parts_; }

  // Calls `visit(part, triangle)` for the triangles of the parts for which `chosen` is true.
  template <class Visit>
  void for_each_triangle(const std::vector<char>& chosen, const Visit& visit) const {
    for (size_t i = 0; i < instances_.size(); ++i) {
      if (part_of_vertex_.empty() && !chosen[i]) continue;
      const Mesh& mesh = mesh_of(instances_[i]);
      const glm::dmat4x3 world(world_from_mesh(mesh, instances_[i].instance));
      const double side = glm::determinant(glm::dmat3(world)) < 0.0 ? -1.0 : 1.0;
      for (size_t k = 0; k + 2 < mesh.indices.size(); k += 3) {
        const size_t part = part_index(i, mesh.indices[k]);
        if (!chosen[part]) continue;
        WorldTriangle triangle;
        for (size_t c = 0; c < 3; ++c)
          triangle.corners[c] = world * glm::dvec4(mesh.positions[mesh.indices[k + c]], 1.0);
        const auto& [a, b, c] = triangle.corners;
        triangle.normal = side * glm::cross(b - a, c - a);
        triangle.double_sided = scene_.materials[mesh.material].double_sided;
        visit(part, triangle);
      }
    }
  }

 private:
  static constexpr uint64_t kMostVertices = uint64_t{1} << 23;

  const Mesh& mesh_of(const MeshInstance& instance) const { return scene_.meshes[instance.mesh]; }
  size_t part_index(size_t instance, uint32_t vertex) const {
    return part_of_vertex_.empty() ? instance : part_of_vertex_[first_vertices_[instance] + vertex];
  }

  // Makes each instance a part.
  void take_instances() {
    std::vector<double> areas;  // by mesh
    for (const Mesh& mesh : scene_.meshes) {
      double area = 0.0;
      for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
        area += 0.5 * glm::length(area_of(mesh, i));
      areas.push_back(area);
    }
    for (const MeshInstance& instance : instances_) {
      const glm::dmat3 scale(glm::dmat4x3(world_from_mesh(mesh_of(instance), instance.instance)));
      const double growth = std::pow(std::abs(glm::determinant(scale)), 2.0 / 3.0);
      parts_.push_back({instance.bounds_ws, growth * areas[instance.mesh],
                        mesh_of(instance).indices.size() / 3});
    }
  }

  void connect(uint64_t vertices) {
    DisjointSets sets(vertices);
    std::vector<glm::vec3> positions;
    positions.reserve(vertices);
    for (size_t i = 0; i < instances_.size(); ++i) {
      const Mesh& mesh = mesh_of(instances_[i]);
      const glm::mat4x3 world = world_from_mesh(mesh, instances_[i].instance);
      for (const glm::vec3& p : mesh.positions) positions.push_back(world * glm::vec4(p, 1.0f));
      for (size_t k = 0; k + 2 < mesh.indices.size(); k += 3) {
        sets.join(first_vertices_[i] + mesh.indices[k], first_vertices_[i] + mesh.indices[k + 1]);
        sets.join(first_vertices_[i] + mesh.indices[k], first_vertices_[i] + mesh.indices[k + 2]);
      }
    }
    join_touching(positions, sets);
    std::vector<uint32_t> part_of_root(vertices, UINT32_MAX);
    part_of_vertex_.resize(vertices);
    for (uint32_t v = 0; v < vertices; ++v) {
      uint32_t& part = part_of_root[sets.root(v)];
      if (part == UINT32_MAX) {
        part = static_cast<uint32_t>(parts_.size());
        parts_.emplace_back();
      }
      part_of_vertex_[v] = part;
      parts_[part].bounds_ws = united(parts_[part].bounds_ws, {positions[v], positions[v]});
    }
    for_each_triangle(std::vector<char>(parts_.size(), 1),
                      [&](size_t part, const WorldTriangle& triangle) {
                        parts_[part].area += 0.5 * glm::length(triangle.normal);
                        ++parts_[part].triangles;
                      });
  }

  const Scene& scene_;
  std::vector<MeshInstance> instances_;
  std::vector<uint32_t> first_vertices_;  // by instance, into part_of_vertex_
  std::vector<uint32_t> part_of_vertex_;  // empty if each instance is a part
  std::vector<Part> parts_;
};

// Returns the group of neighbouring parts with the greatest area. As long as a gap along an axis is
// too wide, the side with less area is left out. Of several such gaps, the one is taken that leaves
// the smallest bounds.
std::vector<uint32_t> greatest_group(const std::vector<Part>& parts, std::vector<uint32_t> group) {
  constexpr double kWidestGap = 2.0;  // in sizes of the smaller side
  struct Side {
    Bounds bounds = empty_bounds();
    double area = 0.0;
    void add(const Part& part) {
      bounds = united(bounds, part.bounds_ws);
      area += part.area;
    }
  };
  for (int cuts = 0; cuts < 64; ++cuts) {
    double smallest = INFINITY;
    std::vector<uint32_t> rest;
    for (int axis = 0; axis < 3; ++axis) {
      const auto low = [&](uint32_t p) { return parts[p].bounds_ws.low[axis]; };
      std::ranges::stable_sort(group, {}, low);
      std::vector<Side> above(group.size() + 1);  // of the parts from an index on
      for (size_t i = group.size(); i-- > 0;) {
        above[i] = above[i + 1];
        above[i].add(parts[group[i]]);
      }
      Side below;
      for (size_t i = 0; i + 1 < group.size(); ++i) {
        below.add(parts[group[i]]);
        const double gap = double{low(group[i + 1])} - double{below.bounds.high[axis]};
        if (!(gap > 0.0)) continue;
        const bool keep_below = below.area >= above[i + 1].area;
        const Side& greater = keep_below ? below : above[i + 1];
        const Side& smaller = keep_below ? above[i + 1] : below;
        const double size = diagonal(greater.bounds);
        if (size >= smallest || gap <= kWidestGap * size * std::sqrt(smaller.area / greater.area))
          continue;
        smallest = size;
        const auto cut = group.begin() + static_cast<ptrdiff_t>(i) + 1;
        rest = keep_below ? std::vector(group.begin(), cut) : std::vector(cut, group.end());
      }
    }
    if (rest.empty()) break;
    group = std::move(rest);
  }
  return group;
}

// Rays from the centre of the subject: eight to the sides, five up, one down, and one to each
// candidate eye.
constexpr size_t kSides = 8, kUp = 5, kDown = kSides + kUp, kToEyes = kDown + 1;
constexpr size_t kRays = kToEyes + kSidesOfSubject.size();

std::array<glm::dvec3, kRays> ray_directions() {
  std::array<glm::dvec3, kRays> out;
  for (size_t i = 0; i < kSides; ++i) {
    // The angle is not a multiple of a quarter turn, so that rays do not meet edges of boxes.
    const double angle = 0.7854 * static_cast<double>(i) + 0.19;
    out[i] = {std::cos(angle), 0.03, std::sin(angle)};
  }
  for (size_t i = 0; i + 1 < kUp; ++i) {
    const double angle = 1.5708 * static_cast<double>(i) + 0.4;
    out[kSides + i] = glm::normalize(glm::dvec3(std::cos(angle), 1.1, std::sin(angle)));
  }
  out[kSides + 4] = {0.011, 1.0, 0.017};
  out[kDown] = {0.011, -1.0, 0.017};
  for (size_t i = 0; i < kSidesOfSubject.size(); ++i)
    out[kToEyes + i] = glm::normalize(glm::dvec3(kSidesOfSubject[i]));
  return out;
}

// Returns the distance at which a ray meets a triangle, or infinity (Moeller and Trumbore 1997).
double distance_to(const WorldTriangle& triangle, const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 e1 = triangle.corners[1] - triangle.corners[0];
  const glm::dvec3 e2 = triangle.corners[2] - triangle.corners[0];
  const glm::dvec3 p = glm::cross(to, e2);
  const double determinant = glm::dot(e1, p);
  if (determinant == 0.0) return INFINITY;
  const glm::dvec3 s = from - triangle.corners[0], q = glm::cross(s, e1);
  const double u = glm::dot(s, p) / determinant, v = glm::dot(to, q) / determinant;
  const double t = glm::dot(e2, q) / determinant;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 ? t : INFINITY;
}

// How a part surrounds a point, and whether it is flat.
struct Enclosure {
  std::array<int, kRays> hits{};
  std::array<double, kRays> nearest;
  std::array<bool, kRays> shows_front{};  // of the nearest hit
  bool double_sided = false;
  double area = 0.0, upright_area = 0.0;  // of horizontal faces and upright walls
  glm::dvec3 sum{0.0};
  glm::dmat3 products{0.0};

  Enclosure() { nearest.fill(INFINITY); }

  void add(const WorldTriangle& triangle, const glm::dvec3& from,
           const std::array<glm::dvec3, kRays>& directions) {
    for (size_t i = 0; i < kRays; ++i) {
      const double t = distance_to(triangle, from, directions[i]);
      if (!std::isfinite(t)) continue;
      ++hits[i];
      if (t >= nearest[i]) continue;
      nearest[i] = t;
      shows_front[i] = glm::dot(triangle.normal, directions[i]) < 0.0;
    }
    double_sided |= triangle.double_sided;
    const double twice = glm::length(triangle.normal);
    if (!(twice > 0.0)) return;
    const double tilt = std::abs(triangle.normal.y) / twice;
    area += twice;
    if (tilt < 0.17 || tilt > 0.985) upright_area += twice;  // within 10 degrees
    for (const glm::dvec3& corner : triangle.corners) {
      sum += twice * (corner - from);
      products += twice * glm::outerProduct(corner - from, corner - from);
    }
  }

  // Returns whether the part is a flat sheet or slab whose plane, at the subject, lies within it.
  bool is_plane_behind(const glm::dvec3& from, const Bounds& bounds) const {
    constexpr double kThinnest = 0.05;  // standard deviation relative to that of the longest axis
    const double weight = 3.0 * std::max(area, 1e-300);
    const glm::dvec3 mean = sum / weight;
    const glm::dmat3 covariance = products / weight - glm::outerProduct(mean, mean);
    const double trace = covariance[0][0] + covariance[1][1] + covariance[2][2];
    // The axis of least variance, by power iteration of the complement.
    const glm::dmat3 complement = glm::dmat3(trace) - covariance;
    glm::dvec3 normal(0.577, 0.605, 0.549);
    for (int i = 0; i < 200; ++i) normal = glm::normalize(complement * normal);
    if (glm::dot(normal, covariance * normal) > kThinnest * kThinnest * trace) return false;
    const glm::dvec3 at = from + normal * glm::dot(mean, normal);
    const double slack = 0.02 * diagonal(bounds);
    return contains(
        {glm::vec3(glm::dvec3(bounds.low) - slack), glm::vec3(glm::dvec3(bounds.high) + slack)},
        glm::vec3(at));
  }

  int directions(size_t first, size_t count) const {
    return static_cast<int>(std::count_if(hits.begin() + static_cast<ptrdiff_t>(first),
                                          hits.begin() + static_cast<ptrdiff_t>(first + count),
                                          [](int n) { return n > 0; }));
  }
  // Returns whether rays from the subject meet the part only once, because it is no solid.
  bool is_sheet() const {
    const int crossings = std::accumulate(hits.begin(), hits.begin() + kToEyes, 0);
    return crossings > 0 && 4 * crossings <= 5 * directions(0, kToEyes);
  }
};

enum class Kind { subject, surroundings, room };

// Judges the candidates, large parts that have been seen from the centre of the rest.
Kind judge(const std::vector<Part>& parts, const std::vector<uint32_t>& candidates,
           const std::vector<Enclosure>& enclosures, const Bounds& rest) {
  const glm::dvec3 centre = middle(rest);
  Enclosure all;
  bool all_flat = true, all_behind = true;
  for (size_t i = 0; i < candidates.size(); ++i) {
    const Bounds& bounds = parts[candidates[i]].bounds_ws;
    const bool flat = enclosures[i].is_plane_behind(centre, bounds);
    if (!flat && !(enclosures[i].is_sheet() && enclosures[i].directions(0, kDown) >= 2))
      return Kind::subject;
    all_flat &= flat;
    all_behind &= flat || (contains(bounds, rest.low + 0.05f * (rest.high - rest.low)) &&
                           contains(bounds, rest.high - 0.05f * (rest.high - rest.low)));
    all.double_sided |= enclosures[i].double_sided;
    all.area += enclosures[i].area;
    all.upright_area += enclosures[i].upright_area;
    for (size_t r = 0; r < kRays; ++r) {
      all.hits[r] += enclosures[i].hits[r];
      if (enclosures[i].nearest[r] >= all.nearest[r]) continue;
      all.nearest[r] = enclosures[i].nearest[r];
      all.shows_front[r] = enclosures[i].shows_front[r];
    }
  }
  const double ratio = diagonal(parts[candidates.back()].bounds_ws) / diagonal(rest);
  const bool walled = all.directions(0, kSides) >= 7, roofed = all.directions(kSides, kUp) == 5;
  if (walled && roofed) {
    const auto fronts = std::count(all.shows_front.begin(), all.shows_front.begin() + kDown, true);
    // Without fronts inside, the candidates are a body with inner parts, or a sky turned outwards.
    if (2 * fronts < static_cast<ptrdiff_t>(kDown) && !(all.double_sided && ratio > 8.0))
      return Kind::subject;
    const double floor = centre.y - rest.low.y + 0.1 * diagonal(rest);
    const bool stands = all.nearest[kDown] <= floor;
    if (stands && all.upright_area > 0.6 * all.area && ratio < 64.0) return Kind::room;
    return Kind::surroundings;
  }
  if (walled) return Kind::subject;  // a gallery or courtyard that is open above
  const bool large = ratio > 3.0 && (all_flat || ratio < 30.0);
  return large && all_behind ? Kind::surroundings : Kind::subject;
}

// Returns the parts to group, the largest first. Of many parts these are the largest, which may be
// surroundings, and evenly spaced ones of the others.
std::vector<uint32_t> parts_to_group(const std::vector<Part>& parts) {
  const auto size = [&](uint32_t p) { return diagonal(parts[p].bounds_ws); };
  std::vector<uint32_t> order(parts.size());
  std::iota(order.begin(), order.end(), 0u);
  if (order.size() > kMostGrouped) {
    constexpr size_t kLargest = 1024;
    std::ranges::nth_element(order, order.begin() + kLargest, std::greater<>(), size);
    const size_t step = order.size() / kMostGrouped + 1;
    size_t count = kLargest;
    for (size_t i = kLargest; i < order.size(); i += step) order[count++] = order[i];
    order.resize(count);
  }
  std::ranges::stable_sort(order, std::greater<>(), size);
  return order;
}

struct Separation {
  std::vector<uint32_t> subject;  // its parts
  std::vector<char> shells;       // by part: whether it would hide the subject from outside
};

// Separates the subject from its surroundings. `order` has the parts, the largest first.
Separation separate(const Parts& found, const std::vector<uint32_t>& order) {
  const std::vector<Part>& parts = found.all();
  const auto size = [&](size_t i) { return diagonal(parts[order[i]].bounds_ws); };
  const auto directions = ray_directions();
  Separation out{greatest_group(parts, order), std::vector<char>(parts.size(), 0)};
  constexpr size_t kMostSurroundings = 32;
  for (size_t k = 1; k < std::min(order.size(), kMostSurroundings); ++k) {
    constexpr double kLarger = 1.5;  // than the next part, and than the rest
    if (size(k - 1) < kLarger * size(k)) continue;
    const auto begin = order.begin() + static_cast<ptrdiff_t>(k);
    const auto rest = greatest_group(parts, {begin, order.end()});
    Bounds bounds = empty_bounds();
    for (const uint32_t p : rest) bounds = united(bounds, parts[p].bounds_ws);
    if (size(k - 1) < kLarger * diagonal(bounds)) continue;
    const std::vector<uint32_t> candidates(order.begin(), begin);
    std::vector<char> chosen(parts.size(), 0);  // one more than the index of a candidate
    for (size_t i = 0; i < k; ++i) chosen[candidates[i]] = static_cast<char>(i + 1);
    std::vector<Enclosure> enclosures(k);
    found.for_each_triangle(chosen, [&](size_t part, const WorldTriangle& triangle) {
      enclosures[static_cast<size_t>(chosen[part] - 1)].add(triangle, middle(bounds), directions);
    });
    const Kind kind = judge(parts, candidates, enclosures, bounds);
    if (kind == Kind::subject) continue;
    // The eye stays inside of a sky, and of a room that hides its inside from eyes outside. A
    // ground or backdrop, which no ray up meets, hides nothing.
    out.shells.assign(parts.size(), 0);
    for (size_t i = 0; i < k; ++i) {
      out.shells[candidates[i]] = enclosures[i].is_sheet() &&
                                  enclosures[i].directions(kSides, kUp) > 0 &&
                                  (kind == Kind::surroundings || enclosures[i].double_sided);
    }
    if (kind == Kind::surroundings) out.subject = rest;
  }
  return out;
}

// Returns the distances from a point at which the parts of `shells` hide it from each side.
std::array<float, 4> free_distances(const Parts& found, const std::vector<char>& shells,
                                    const glm::dvec3& from) {
  const auto directions = ray_directions();
  Enclosure shell;
  found.for_each_triangle(shells, [&](size_t, const WorldTriangle& triangle) {
    shell.add(triangle, from, directions);
  });
  std::array<float, 4> out;
  std::transform(shell.nearest.begin() + kToEyes, shell.nearest.end(), out.begin(),
                 [](double d) { return static_cast<float>(d); });
  return out;
}

}  // namespace

Subject find_subject(const Scene& scene) {
  const Parts found(scene);
  const std::vector<Part>& parts = found.all();
  if (parts.empty()) return {};
  const std::vector<uint32_t> order = parts_to_group(parts);
  const bool sampled = order.size() < parts.size();
  const Separation separation = separate(found, order);
  Subject out{empty_bounds()};
  std::vector<char> grouped(parts.size(), 0);
  for (const uint32_t p : separation.subject) {
    grouped[p] = 1;
    out.bounds_ws = united(out.bounds_ws, parts[p].bounds_ws);
  }
  out.free_distance_ws = free_distances(found, separation.shells, middle(out.bounds_ws));
  // Parts that were not sampled belong to the subject if they lie in it or at its border.
  const float border = sampled ? static_cast<float>(0.05 * diagonal(out.bounds_ws)) : 0.0f;
  const Bounds around{out.bounds_ws.low - border, out.bounds_ws.high + border};
  const double largest = diagonal(out.bounds_ws);
  for (size_t p = 0; p < parts.size(); ++p) {
    const Bounds& bounds = parts[p].bounds_ws;
    if (!grouped[p] && !(contains(around, glm::vec3(middle(bounds))) && diagonal(bounds) < largest))
      out.triangles_outside += parts[p].triangles;
    else if (sampled)
      out.bounds_ws = united(out.bounds_ws, bounds);
  }
  return out;
}

}  // namespace alcove::sample
