#include "scene/framing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <span>
#include <utility>

#include "scene/area.h"
#include "support/parallel.h"

namespace alcove::sample {
namespace {

double diagonal(const Bounds& bounds) {
  return glm::length(glm::dvec3(bounds.high) - glm::dvec3(bounds.low));
}

Bounds no_bounds() {
  return {glm::vec3(std::numeric_limits<float>::infinity()),
          glm::vec3(-std::numeric_limits<float>::infinity())};
}

Bounds united(const Bounds& a, const Bounds& b) {
  return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

bool holds(const Bounds& bounds, const glm::vec3& point) {
  return glm::all(glm::lessThanEqual(bounds.low, point)) &&
         glm::all(glm::lessThanEqual(point, bounds.high));
}

Bounds placed_bounds(const Bounds& bounds, const glm::mat4x3& world_from_mesh) {
  Bounds out = no_bounds();
  for (const glm::vec3& corner : corners_of(bounds)) {
    const glm::vec3 placed = world_from_mesh * glm::vec4(corner, 1.0f);
    out = united(out, {placed, placed});
  }
  return out;
}

// An instance of a mesh.
struct Item {
  size_t mesh;
  Bounds bounds_ws;
  double triangles;
};

std::vector<Item> items_of(const std::vector<Mesh>& meshes) {
  std::vector<Item> items;
  for (size_t m = 0; m < meshes.size(); ++m) {
    const Mesh& mesh = meshes[m];
    if (mesh.indices.empty()) continue;
    Bounds own = no_bounds();
    for (const uint32_t i : mesh.indices) {
      own = united(own, {mesh.positions_ws[i], mesh.positions_ws[i]});
    }
    const auto triangles = static_cast<double>(mesh.indices.size() / 3);
    if (mesh.instances.empty()) items.push_back({m, own, triangles});
    for (const glm::mat4x3& placed : mesh.instances) {
      items.push_back({m, placed_bounds(own, placed), triangles});
    }
  }
  return items;
}

// Whether an item only surrounds the rest, which is smaller: a plane, or a shell around it. The
// rest must have an eighth of its triangles at least, so that a large model is not taken for the
// surroundings of a part of it.
bool surrounds(const Item& item, const Bounds& rest, double triangles_of_rest) {
  if (8.0 * triangles_of_rest < item.triangles) return false;
  const glm::vec3 size = item.bounds_ws.high - item.bounds_ws.low;
  const float longest = std::max({size.x, size.y, size.z});
  const float shortest = std::min({size.x, size.y, size.z});
  if (shortest < 0.02f * longest) return true;
  const glm::vec3 slack = 0.05f * (rest.high - rest.low);
  return holds(item.bounds_ws, rest.low + slack) && holds(item.bounds_ws, rest.high - slack);
}

constexpr double kStretch = 4.0;       // bounds that shrink by less are left as they are
constexpr double kSurrounding = 10.0;  // times larger than the rest is what only surrounds it

// Sorted by size; the number of items at the front that only surround the others.
size_t count_of_surroundings(const std::vector<Item>& sorted) {
  const size_t count = sorted.size();
  std::vector<Bounds> from(count + 1, no_bounds());
  std::vector<double> triangles(count + 1, 0.0);
  for (size_t i = count; i-- > 0;) {
    from[i] = united(from[i + 1], sorted[i].bounds_ws);
    triangles[i] = triangles[i + 1] + sorted[i].triangles;
  }
  size_t left_out = 0;
  for (size_t k = 1; k < count; ++k) {
    const Item& item = sorted[k - 1];
    if (!surrounds(item, from[k], triangles[k])) break;
    if (diagonal(item.bounds_ws) > kSurrounding * diagonal(from[k])) left_out = k;
  }
  return left_out;
}

// A triangle, or an instance of a mesh as a whole.
struct Unit {
  Bounds bounds_ws;
  double triangles;
  double area;
};

template <class Visit>
void for_each_unit(const std::vector<Mesh>& meshes, std::span<const Item> items,
                   const Visit& visit) {
  for (const Item& item : items) {
    const Mesh& mesh = meshes[item.mesh];
    if (!mesh.instances.empty()) {
      const glm::dvec3 size(item.bounds_ws.high - item.bounds_ws.low);
      visit(Unit{item.bounds_ws, item.triangles,
                 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x)});
      continue;
    }
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      Bounds bounds = no_bounds();
      for (size_t c = 0; c < 3; ++c) {
        const glm::vec3& position = mesh.positions_ws[mesh.indices[i + c]];
        bounds = united(bounds, {position, position});
      }
      visit(Unit{bounds, 1.0, 0.5 * glm::length(area_of(mesh, i))});
    }
  }
}

struct Sample {
  glm::vec3 middle;
  double weight;
};

// The bounds of the middles between two quantiles of the samples' weight, for each axis alone.
Bounds quantile_bounds(std::vector<Sample>& samples) {
  constexpr double kShare = 0.005;  // of the weight, outside at either end
  double total = 0.0;
  for (const Sample& sample : samples) total += sample.weight;
  Bounds out;
  for (int c = 0; c < 3; ++c) {
    std::ranges::sort(samples, {}, [c](const Sample& sample) { return sample.middle[c]; });
    double sum = 0.0;
    size_t i = 0;
    while (i + 1 < samples.size() && (sum += samples[i].weight) <= kShare * total) ++i;
    out.low[c] = samples[i].middle[c];
    sum = 0.0;
    i = samples.size() - 1;
    while (i > 0 && (sum += samples[i].weight) <= kShare * total) --i;
    out.high[c] = samples[i].middle[c];
  }
  return out;
}

// The units near the central ones, by number of triangles or by area.
SceneCore trimmed(const std::vector<Mesh>& meshes, std::span<const Item> items, bool by_area) {
  constexpr uint64_t kMostSamples = 1u << 16;
  uint64_t units = 0;
  for (const Item& item : items) {
    units += meshes[item.mesh].instances.empty() ? static_cast<uint64_t>(item.triangles) : 1;
  }
  const uint64_t step = units / kMostSamples + 1;
  std::vector<Sample> samples;
  uint64_t index = 0;
  for_each_unit(meshes, items, [&](const Unit& unit) {
    if (index++ % step != 0) return;
    samples.push_back(
        {0.5f * (unit.bounds_ws.low + unit.bounds_ws.high), by_area ? unit.area : unit.triangles});
  });
  const Bounds central = quantile_bounds(samples);
  const auto margin = static_cast<float>(diagonal(central));
  const Bounds around{central.low - margin, central.high + margin};
  SceneCore core{no_bounds(), 0};
  for_each_unit(meshes, items, [&](const Unit& unit) {
    if (holds(around, 0.5f * (unit.bounds_ws.low + unit.bounds_ws.high))) {
      core.bounds_ws = united(core.bounds_ws, unit.bounds_ws);
    } else {
      core.triangles_outside += static_cast<uint64_t>(unit.triangles);
    }
  });
  return core;
}

// The part of a convex polygon where `plane` . (x, y, z, 1) is not negative.
using Polygon = std::vector<glm::dvec3>;
void clip(Polygon& polygon, const glm::dvec4& plane) {
  const auto distance = [&](const glm::dvec3& p) {
    return glm::dot(glm::dvec3(plane), p) + plane.w;
  };
  Polygon out;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3& a = polygon[i];
    const glm::dvec3& b = polygon[(i + 1) % polygon.size()];
    const double da = distance(a), db = distance(b);
    if (da >= 0.0) out.push_back(a);
    if ((da < 0.0) != (db < 0.0)) out.push_back(glm::mix(a, b, da / (da - db)));
  }
  polygon = std::move(out);
}

// The image's four sides in view space, and in perspective the eye's plane.
std::vector<glm::dvec4> side_planes(const Camera& camera, double aspect) {
  if (camera.orthographic) {
    const double y = 0.5 * camera.ortho_height, x = y * aspect;
    return {{1, 0, 0, x}, {-1, 0, 0, x}, {0, 1, 0, y}, {0, -1, 0, y}};
  }
  const double y = std::tan(0.5 * camera.fov_y), x = y * aspect;
  return {{1, 0, -x, 0}, {-1, 0, -x, 0}, {0, 1, -y, 0}, {0, -1, -y, 0}, {0, 0, -1, 0}};
}

class DepthSearch {
 public:
  DepthSearch(const Camera& camera, double aspect)
      : view_from_world_(camera_matrices(camera, 1, 1).view_from_world),
        planes_(side_planes(camera, aspect)) {}

  // Whether points are all beyond one of the planes.
  template <size_t N>
  bool is_outside(const std::array<glm::dvec3, N>& points) const {
    return std::ranges::any_of(planes_, [&](const glm::dvec4& plane) {
      return std::ranges::all_of(points, [&](const glm::dvec3& p) {
        return glm::dot(glm::dvec3(plane), p) + plane.w < 0.0;
      });
    });
  }

  void add(const std::array<glm::dvec3, 3>& triangle_vs, DepthRange& range) const {
    if (is_outside(triangle_vs)) return;
    Polygon polygon(triangle_vs.begin(), triangle_vs.end());
    for (const glm::dvec4& plane : planes_) clip(polygon, plane);
    for (const glm::dvec3& p : polygon) {
      range.nearest = std::min(range.nearest, -p.z);
      range.farthest = std::max(range.farthest, -p.z);
    }
  }

  glm::dvec3 view_position(const glm::mat4x3& placed, const glm::vec3& position) const {
    const glm::dvec3 world = glm::dmat4x3(placed) * glm::dvec4(position, 1.0);
    return glm::dvec3(glm::dmat4(view_from_world_) * glm::dvec4(world, 1.0));
  }

 private:
  glm::mat4 view_from_world_;
  std::vector<glm::dvec4> planes_;
};

// Part of the triangles of an instance.
struct Batch {
  const Mesh* mesh;
  glm::mat4x3 placed;
  size_t first;  // index
  size_t last;
};

std::vector<Batch> batches_in_view(const Scene& scene, const DepthSearch& search) {
  constexpr size_t kIndices = size_t{3} << 16;
  std::vector<Batch> batches;
  for (const Mesh& mesh : scene.meshes) {
    Bounds own = no_bounds();
    for (const uint32_t i : mesh.indices) {
      own = united(own, {mesh.positions_ws[i], mesh.positions_ws[i]});
    }
    for (size_t instance = 0; instance < instance_count(mesh); ++instance) {
      const glm::mat4x3 placed = world_from_mesh(mesh, instance);
      std::array<glm::dvec3, 8> corners_vs;
      const auto corners = corners_of(own);
      for (size_t i = 0; i < 8; ++i) corners_vs[i] = search.view_position(placed, corners[i]);
      if (mesh.indices.empty() || search.is_outside(corners_vs)) continue;
      for (size_t first = 0; first + 2 < mesh.indices.size(); first += kIndices) {
        batches.push_back({&mesh, placed, first, std::min(first + kIndices, mesh.indices.size())});
      }
    }
  }
  return batches;
}

}  // namespace

SceneCore scene_core(const std::vector<Mesh>& meshes) {
  std::vector<Item> items = items_of(meshes);
  if (items.empty()) return {};
  std::ranges::stable_sort(items, std::greater<>(),
                           [](const Item& item) { return diagonal(item.bounds_ws); });
  const size_t surroundings = count_of_surroundings(items);
  SceneCore core{no_bounds(), 0};
  for (size_t i = 0; i < surroundings; ++i) {
    core.triangles_outside += static_cast<uint64_t>(items[i].triangles);
  }
  const std::span<const Item> rest = std::span<const Item>(items).subspan(surroundings);
  for (const Item& item : rest) core.bounds_ws = united(core.bounds_ws, item.bounds_ws);
  for (const bool by_area : {false, true}) {
    const SceneCore trim = trimmed(meshes, rest, by_area);
    if (kStretch * diagonal(trim.bounds_ws) < diagonal(core.bounds_ws)) {
      const uint64_t outside = trim.triangles_outside;
      core.bounds_ws = trim.bounds_ws;
      core.triangles_outside = outside;
      for (size_t i = 0; i < surroundings; ++i) {
        core.triangles_outside += static_cast<uint64_t>(items[i].triangles);
      }
    }
  }
  return core;
}

Camera framing_camera(const Scene& scene) {
  const Bounds& bounds = scene.core_bounds_ws;
  const glm::vec3 centre = 0.5f * (bounds.low + bounds.high);
  const float reach = std::max(0.5f * glm::length(bounds.high - bounds.low), 1e-6f);
  Camera camera;
  camera.name = "frame";
  camera.origin = scene.origin;
  camera.fov_y = glm::radians(45.0f);
  const float distance = 1.05f * reach / std::sin(0.5f * camera.fov_y);
  camera.target_ws = centre;
  camera.near_plane = 0.02f * reach;
  camera.far_plane =
      distance + 4.0f * std::max(reach, glm::length(scene.bounds_ws.high - scene.bounds_ws.low));
  camera.fit_planes = true;
  // Four sides to stand at. What surrounds the core and holds its middle should hold the eye too.
  std::vector<Bounds> shells;
  for (const Item& item : items_of(scene.meshes)) {
    const glm::vec3 size = item.bounds_ws.high - item.bounds_ws.low;
    const float shortest = std::min({size.x, size.y, size.z});
    if (diagonal(item.bounds_ws) > kStretch * diagonal(bounds) && shortest > reach &&
        holds(item.bounds_ws, centre)) {
      shells.push_back(item.bounds_ws);
    }
  }
  for (const glm::vec3 side : {glm::vec3(0.6f, 0.45f, 0.85f), glm::vec3(-0.85f, 0.45f, 0.6f),
                               glm::vec3(-0.6f, 0.45f, -0.85f), glm::vec3(0.85f, 0.45f, -0.6f),
                               glm::vec3(0.6f, 0.45f, 0.85f)}) {
    camera.eye_ws = centre + distance * glm::normalize(side);
    if (std::ranges::all_of(shells, [&](const Bounds& b) { return holds(b, camera.eye_ws); })) {
      break;
    }
  }
  return camera;
}

std::optional<DepthRange> depth_in_view(const Scene& scene, const Camera& camera, double aspect) {
  const DepthSearch search(camera, aspect);
  const std::vector<Batch> batches = batches_in_view(scene, search);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  DepthRange range{kInfinity, -kInfinity};
  std::mutex mutex;
  parallel_rows(static_cast<uint32_t>(batches.size()), [&](uint32_t b) {
    const Batch& batch = batches[b];
    DepthRange own{kInfinity, -kInfinity};
    for (size_t i = batch.first; i + 2 < batch.last; i += 3) {
      std::array<glm::dvec3, 3> triangle;
      for (size_t c = 0; c < 3; ++c) {
        triangle[c] = search.view_position(batch.placed,
                                           batch.mesh->positions_ws[batch.mesh->indices[i + c]]);
      }
      search.add(triangle, own);
    }
    const std::lock_guard lock(mutex);
    range.nearest = std::min(range.nearest, own.nearest);
    range.farthest = std::max(range.farthest, own.farthest);
  });
  if (!(range.nearest <= range.farthest)) return std::nullopt;
  return range;
}

Camera with_fitted_planes(const Scene& scene, const Camera& camera, double aspect) {
  const auto range = depth_in_view(scene, camera, aspect);
  if (!range) return camera;
  Camera out = camera;
  const double size = diagonal(scene.core_bounds_ws);
  // Positions and planes are floats: far behind the farthest triangle by what they round to.
  const double margin = 1e-3 * std::max(size, range->farthest - range->nearest);
  if (camera.orthographic) {
    out.near_plane = static_cast<float>(range->nearest - margin);
    out.far_plane = static_cast<float>(range->farthest + margin);
  } else {
    // The view may turn and move afterwards, within the scene.
    double farthest = range->farthest;
    for (const glm::vec3& corner : corners_of(scene.core_bounds_ws)) {
      farthest = std::max(farthest, double(glm::distance(corner, camera.eye_ws)) + 2.0 * size);
    }
    const double least = std::max(2e-4 * size, 1e-6 * farthest);
    out.near_plane =
        static_cast<float>(std::max(std::min(0.5 * range->nearest, 0.01 * size), least));
    out.far_plane = static_cast<float>(std::max(farthest + margin, 2.0 * out.near_plane));
  }
  return out.near_plane < out.far_plane ? out : camera;
}

}  // namespace alcove::sample
