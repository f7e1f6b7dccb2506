#include "scene/depth_range.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "support/parallel.h"

namespace alcove::sample {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Polygon = std::vector<glm::dvec3>;

double distance(const glm::dvec4& plane, const glm::dvec3& p) {
  return glm::dot(glm::dvec3(plane), p) + plane.w;
}

// Cuts off the part of a convex polygon at the negative side of a plane.
void clip(Polygon& polygon, const glm::dvec4& plane) {
  Polygon out;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3& a = polygon[i];
    const glm::dvec3& b = polygon[(i + 1) % polygon.size()];
    const double da = distance(plane, a), db = distance(plane, b);
    if (da >= 0.0) out.push_back(a);
    if ((da < 0.0) != (db < 0.0)) out.push_back(glm::mix(a, b, da / (da - db)));
  }
  polygon = std::move(out);
}

// Returns the planes of the image's four sides in view space, and in perspective also the plane
// through the eye. The visible part of space is on their positive sides.
std::vector<glm::dvec4> side_planes(const Camera& camera, double aspect) {
  if (camera.orthographic) {
    const double y = 0.5 * camera.ortho_height, x = y * aspect;
    return {{1, 0, 0, x}, {-1, 0, 0, x}, {0, 1, 0, y}, {0, -1, 0, y}};
  }
  const double y = std::tan(0.5 * camera.fov_y), x = y * aspect;
  return {{1, 0, -x, 0}, {-1, 0, -x, 0}, {0, 1, -y, 0}, {0, -1, -y, 0}, {0, 0, -1, 0}};
}

// A block of consecutive triangles of a mesh.
struct Block {
  size_t first;  // index
  size_t last;
  Bounds bounds;  // in mesh space
};

std::vector<Block> blocks_of(const Mesh& mesh) {
  constexpr size_t kIndices = size_t{3} << 16;
  std::vector<Block> blocks;
  const size_t count = mesh.indices.size() / 3 * 3;
  for (size_t first = 0; first < count; first += kIndices) {
    const size_t last = std::min(first + kIndices, count);
    blocks.push_back({first, last, bounds_of_triangles(mesh, first, last)});
  }
  return blocks;
}

DepthRange united(const DepthRange& a, const DepthRange& b) {
  return {std::min(a.nearest, b.nearest), std::max(a.farthest, b.farthest)};
}

// A block of triangles of an instance that may be in view.
struct Candidate {
  uint32_t mesh;
  uint32_t instance;
  uint32_t block;
  DepthRange bounds;  // contains the depths of all of its triangles that are in view
};

// Finds the range of depths in view. Searches the blocks in view, the nearest first, until no
// remaining block can contain a nearer triangle than the nearest one found. Then does the same for
// the farthest.
class DepthSearch {
 public:
  DepthSearch(const Scene& scene, const Camera& camera, double aspect)
      : scene_(scene),
        view_from_world_(camera_matrices(camera, 1, 1).view_from_world),
        perspective_(!camera.orthographic),
        planes_(side_planes(camera, aspect)) {
    for (const Mesh& mesh : scene.meshes) blocks_.push_back(blocks_of(mesh));
  }

  std::optional<DepthRange> run() {
    std::vector<Candidate> candidates = candidates_in_view();
    std::ranges::sort(candidates, {}, [](const Candidate& c) { return c.bounds.nearest; });
    search(candidates, [](const DepthRange& bounds, const DepthRange& found) {
      return bounds.nearest < found.nearest;
    });
    std::ranges::sort(candidates, {}, [](const Candidate& c) { return -c.bounds.farthest; });
    search(candidates, [](const DepthRange& bounds, const DepthRange& found) {
      return bounds.farthest > found.farthest;
    });
    if (!(found_.nearest <= found_.farthest)) return std::nullopt;
    return found_;
  }

 private:
  glm::dmat4 view_from_mesh(const Mesh& mesh, size_t instance) const {
    return view_from_world_ * glm::dmat4(glm::dmat4x3(world_from_mesh(mesh, instance)));
  }

  // Returns whether all points are on the negative side of one of the planes.
  template <size_t N>
  bool is_outside(const std::array<glm::dvec3, N>& points) const {
    return std::ranges::any_of(planes_, [&](const glm::dvec4& plane) {
      return std::ranges::all_of(points,
                                 [&](const glm::dvec3& p) { return distance(plane, p) < 0.0; });
    });
  }

  // Returns the range of depths of a box, or null if it is out of view.
  std::optional<DepthRange> depth_bounds(const Bounds& bounds, const glm::dmat4& view) const {
    std::array<glm::dvec3, 8> corners_vs;
    const auto corners = corners_of(bounds);
    DepthRange out{kInfinity, -kInfinity};
    for (size_t i = 0; i < corners.size(); ++i) {
      corners_vs[i] = glm::dvec3(view * glm::dvec4(corners[i], 1.0));
      out = united(out, {-corners_vs[i].z, -corners_vs[i].z});
    }
    if (is_outside(corners_vs)) return std::nullopt;
    if (perspective_) out.nearest = std::max(out.nearest, 0.0);
    return out;
  }

  std::vector<Candidate> candidates_in_view() const {
    std::vector<Candidate> out;
    for (uint32_t m = 0; m < scene_.meshes.size(); ++m) {
      const Mesh& mesh = scene_.meshes[m];
      const size_t count = blocks_[m].empty() ? 0 : instance_count(mesh);
      for (uint32_t instance = 0; instance < count; ++instance) {
        const glm::dmat4 view = view_from_mesh(mesh, instance);
        for (uint32_t b = 0; b < blocks_[m].size(); ++b) {
          const auto bounds = depth_bounds(blocks_[m][b].bounds, view);
          if (bounds) out.push_back({m, instance, b, *bounds});
        }
      }
    }
    return out;
  }

  // Searches the candidates for which `may_extend` says that they could extend the range found so
  // far. If the limit on triangles is reached, the bounds of the remaining candidates are used
  // instead of their triangles.
  template <class MayExtend>
  void search(const std::vector<Candidate>& candidates, const MayExtend& may_extend) {
    constexpr uint64_t kMostTriangles = uint64_t{1} << 25;
    size_t count = 0;
    for (uint64_t triangles = 0; count < candidates.size() && triangles < kMostTriangles; ++count) {
      const Block& block = block_of(candidates[count]);
      triangles += (block.last - block.first) / 3;
    }
    parallel_rows(static_cast<uint32_t>(count), [&](uint32_t i) {
      const DepthRange found = found_so_far();
      if (may_extend(candidates[i].bounds, found)) extend(extended(found, candidates[i]));
    });
    for (size_t i = count; i < candidates.size(); ++i) {
      if (may_extend(candidates[i].bounds, found_)) extend(candidates[i].bounds);
    }
  }

  const Block& block_of(const Candidate& candidate) const {
    return blocks_[candidate.mesh][candidate.block];
  }

  // Returns the range extended by the triangles of the candidate.
  DepthRange extended(DepthRange range, const Candidate& candidate) const {
    const Mesh& mesh = scene_.meshes[candidate.mesh];
    const Block& block = block_of(candidate);
    const glm::dmat4 view = view_from_mesh(mesh, candidate.instance);
    for (size_t i = block.first; i < block.last; i += 3) {
      std::array<glm::dvec3, 3> triangle_vs;
      for (size_t c = 0; c < 3; ++c) {
        const glm::vec3& position = mesh.positions[mesh.indices[i + c]];
        triangle_vs[c] = glm::dvec3(view * glm::dvec4(position, 1.0));
      }
      extend_by_triangle(triangle_vs, range);
    }
    return range;
  }

  void extend_by_triangle(const std::array<glm::dvec3, 3>& triangle_vs, DepthRange& range) const {
    const auto& [a, b, c] = triangle_vs;
    const bool within =
        -std::max({a.z, b.z, c.z}) >= range.nearest && -std::min({a.z, b.z, c.z}) <= range.farthest;
    if (within || is_outside(triangle_vs)) return;
    Polygon polygon(triangle_vs.begin(), triangle_vs.end());
    for (const glm::dvec4& plane : planes_) clip(polygon, plane);
    for (const glm::dvec3& p : polygon) range = united(range, {-p.z, -p.z});
  }

  DepthRange found_so_far() {
    const std::lock_guard lock(mutex_);
    return found_;
  }
  void extend(const DepthRange& range) {
    const std::lock_guard lock(mutex_);
    found_ = united(found_, range);
  }

  const Scene& scene_;
  glm::dmat4 view_from_world_;
  bool perspective_;
  std::vector<glm::dvec4> planes_;
  std::vector<std::vector<Block>> blocks_;  // by mesh
  std::mutex mutex_;                        // of found_
  DepthRange found_{kInfinity, -kInfinity};
};

}  // namespace

std::optional<DepthRange> depth_in_view(const Scene& scene, const Camera& camera, double aspect) {
  return DepthSearch(scene, camera, aspect).run();
}

Camera with_fitted_planes(const Scene& scene, const Camera& camera, double aspect) {
  const auto range = depth_in_view(scene, camera, aspect);
  if (!range) return camera;
  Camera out = camera;
  const double size = diagonal(scene.core_bounds_ws);
  // The margin covers the rounding of positions and planes, which are floats.
  const double margin = 1e-3 * std::max(size, range->farthest - range->nearest);
  if (camera.orthographic) {
    out.near_plane = static_cast<float>(range->nearest - margin);
    out.far_plane = static_cast<float>(range->farthest + margin);
  } else {
    // The far plane must also be far enough for other positions and directions of the camera within
    // the scene.
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
