#include "scene/scene_core.h"

#include <algorithm>
#include <functional>
#include <span>

#include "scene/area.h"
#include "scene/scene.h"

namespace alcove::sample {
namespace {

constexpr double kStretch = 4.0;       // bounds that would shrink by less are kept
constexpr double kSurrounding = 10.0;  // size of surroundings relative to all smaller instances

uint64_t triangles_of(const std::vector<Mesh>& meshes, const MeshInstance& instance) {
  return meshes[instance.mesh].indices.size() / 3;
}

// Returns whether an instance is flat or encloses all smaller instances. The smaller instances
// together must have at least an eighth of its triangles, because otherwise a large model could
// count as the surroundings of a part of itself.
bool surrounds(const Bounds& bounds, uint64_t triangles, const Bounds& smaller,
               uint64_t triangles_of_smaller) {
  if (8 * triangles_of_smaller < triangles) return false;
  const glm::vec3 size = bounds.high - bounds.low;
  const float longest = std::max({size.x, size.y, size.z});
  const float shortest = std::min({size.x, size.y, size.z});
  if (shortest < 0.02f * longest) return true;
  const glm::vec3 slack = 0.05f * (smaller.high - smaller.low);
  return contains(bounds, smaller.low + slack) && contains(bounds, smaller.high - slack);
}

// Returns the number of instances that are surroundings. The instances are sorted by size, the
// largest first, so that all surroundings come before the core.
size_t count_of_surroundings(const std::vector<Mesh>& meshes,
                             const std::vector<MeshInstance>& sorted) {
  const size_t count = sorted.size();
  std::vector<Bounds> from(count + 1, empty_bounds());  // of instance i and all smaller ones
  std::vector<uint64_t> triangles(count + 1, 0);
  for (size_t i = count; i-- > 0;) {
    from[i] = united(from[i + 1], sorted[i].bounds_ws);
    triangles[i] = triangles[i + 1] + triangles_of(meshes, sorted[i]);
  }
  size_t surroundings = 0;
  for (size_t k = 1; k < count; ++k) {
    const Bounds& bounds = sorted[k - 1].bounds_ws;
    if (!surrounds(bounds, triangles_of(meshes, sorted[k - 1]), from[k], triangles[k])) break;
    if (diagonal(bounds) > kSurrounding * diagonal(from[k])) surroundings = k;
  }
  return surroundings;
}

// The smallest part of a scene that the bounds of its core include or leave out as a whole: a
// triangle of a mesh that has one instance, or one instance of a mesh that has several.
struct Unit {
  Bounds bounds_ws;
  uint64_t triangles;
  double area;
};

template <class Visit>
void for_each_unit(const std::vector<Mesh>& meshes, std::span<const MeshInstance> instances,
                   const Visit& visit) {
  for (const MeshInstance& instance : instances) {
    const Mesh& mesh = meshes[instance.mesh];
    if (!mesh.instances.empty()) {
      const glm::dvec3 size(instance.bounds_ws.high - instance.bounds_ws.low);
      visit(Unit{instance.bounds_ws, triangles_of(meshes, instance),
                 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x)});
      continue;
    }
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      visit(Unit{bounds_of_triangles(mesh, i, i + 3), 1, 0.5 * glm::length(area_of(mesh, i))});
    }
  }
}

glm::vec3 centre_of(const Bounds& bounds) { return 0.5f * (bounds.low + bounds.high); }

struct Sample {
  glm::vec3 centre;
  double weight;
};

// Returns, for each axis, the range of the centres without the lowest and the highest 0.5 % of the
// weight.
Bounds quantile_bounds(std::vector<Sample>& samples) {
  constexpr double kShare = 0.005;
  double total = 0.0;
  for (const Sample& sample : samples) total += sample.weight;
  Bounds out;
  for (int c = 0; c < 3; ++c) {
    std::ranges::sort(samples, {}, [c](const Sample& sample) { return sample.centre[c]; });
    double sum = 0.0;
    size_t i = 0;
    while (i + 1 < samples.size() && (sum += samples[i].weight) <= kShare * total) ++i;
    out.low[c] = samples[i].centre[c];
    sum = 0.0;
    i = samples.size() - 1;
    while (i > 0 && (sum += samples[i].weight) <= kShare * total) --i;
    out.high[c] = samples[i].centre[c];
  }
  return out;
}

// Returns the bounds of the units whose centres are within the central range of all centres, or at
// most the diagonal of that range away from it. If `by_area`, units are weighted by area, otherwise
// by their number of triangles.
SceneCore trimmed(const std::vector<Mesh>& meshes, std::span<const MeshInstance> instances,
                  bool by_area) {
  constexpr uint64_t kMostSamples = 1u << 16;
  uint64_t units = 0;
  for (const MeshInstance& instance : instances) {
    units += meshes[instance.mesh].instances.empty() ? triangles_of(meshes, instance) : 1;
  }
  const uint64_t step = units / kMostSamples + 1;
  std::vector<Sample> samples;
  uint64_t index = 0;
  for_each_unit(meshes, instances, [&](const Unit& unit) {
    if (index++ % step != 0) return;
    samples.push_back(
        {centre_of(unit.bounds_ws), by_area ? unit.area : static_cast<double>(unit.triangles)});
  });
  const Bounds central = quantile_bounds(samples);
  const auto margin = static_cast<float>(diagonal(central));
  const Bounds around{central.low - margin, central.high + margin};
  SceneCore core{empty_bounds(), 0};
  for_each_unit(meshes, instances, [&](const Unit& unit) {
    if (contains(around, centre_of(unit.bounds_ws))) {
      core.bounds_ws = united(core.bounds_ws, unit.bounds_ws);
    } else {
      core.triangles_outside += unit.triangles;
    }
  });
  return core;
}

}  // namespace

SceneCore scene_core(const std::vector<Mesh>& meshes) {
  std::vector<MeshInstance> sorted = instances_of(meshes);
  if (sorted.empty()) return {};
  std::ranges::stable_sort(sorted, std::greater<>(), [](const MeshInstance& instance) {
    return diagonal(instance.bounds_ws);
  });
  const size_t surroundings = count_of_surroundings(meshes, sorted);
  uint64_t triangles_of_surroundings = 0;
  for (size_t i = 0; i < surroundings; ++i) {
    triangles_of_surroundings += triangles_of(meshes, sorted[i]);
  }
  const auto rest = std::span<const MeshInstance>(sorted).subspan(surroundings);
  SceneCore core{empty_bounds(), triangles_of_surroundings};
  for (const MeshInstance& instance : rest) {
    core.bounds_ws = united(core.bounds_ws, instance.bounds_ws);
  }
  for (const bool by_area : {false, true}) {
    const SceneCore trim = trimmed(meshes, rest, by_area);
    if (kStretch * diagonal(trim.bounds_ws) >= diagonal(core.bounds_ws)) continue;
    core = {trim.bounds_ws, trim.triangles_outside + triangles_of_surroundings};
  }
  return core;
}

}  // namespace alcove::sample
