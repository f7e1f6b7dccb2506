#include "scene/framing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "support/median.h"

namespace alcove::sample {
namespace {

using Parts = std::span<const MeshInstance>;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

glm::vec3 size_of(const Bounds& bounds) { return bounds.high - bounds.low; }
glm::vec3 middle(const Bounds& bounds) { return 0.5f * bounds.low + 0.5f * bounds.high; }

bool is_wider(const Bounds& bounds, const Bounds& rest) {
  constexpr double kMost = 1e4;  // a rest that is smaller is nothing to look at
  const glm::vec3 size = size_of(bounds), least = 3.0f * size_of(rest);
  return size.x >= least.x && size.z >= least.z && diagonal(bounds) < kMost * diagonal(rest);
}

bool is_ground(const Bounds& bounds, const Bounds& rest) {
  constexpr float kFlat = 0.005f;  // of the width; a circuit board is thicker
  constexpr float kSunk = 0.2f;    // of the height of the rest, in the ground
  const glm::vec3 size = size_of(bounds);
  return is_wider(bounds, rest) && size.y <= kFlat * std::min(size.x, size.z) &&
         bounds.high.y <= rest.low.y + kSunk * size_of(rest).y;
}

// Returns the distance at which a ray meets a mesh if it meets the front of a face, and no other.
std::optional<float> distance_to_shell(const RayScene& rays, uint32_t mesh, const glm::vec3& from,
                                       const glm::vec3& direction) {
  constexpr int kMostHits = 64;
  std::optional<float> found;
  float distance = 0.0f;
  for (int i = 0; i < kMostHits; ++i) {
    const auto hit = rays.nearest(from + distance * direction, direction, kInfinity, true);
    if (!hit) return found;
    distance = 1.0001f * (distance + hit->distance);
    if (hit->mesh != mesh) continue;
    if (found || !hit->front) break;
    found = distance;
  }
  return std::nullopt;
}

bool is_sky(const RayScene& rays, const MeshInstance& part, const Bounds& rest) {
  const glm::vec3 border = 0.1f * size_of(rest);
  if (!contains(part.bounds_ws, rest.low + border) || !contains(part.bounds_ws, rest.high - border))
    return false;
  for (int i = 0; i < 13; ++i) {  // eight rays to the sides, five up
    const float angle = 0.7854f * static_cast<float>(i) + 0.19f;  // not to the edges of boxes
    const glm::vec3 to(std::cos(angle), i < 8 ? 0.03f : i < 12 ? 1.1f : 50.0f, std::sin(angle));
    if (!distance_to_shell(rays, part.mesh, middle(rest), glm::normalize(to))) return false;
  }
  return true;
}

// Returns the box of parts without strays, and counts the strays.
Bounds bounds_without_strays(const Scene& scene, Parts parts, size_t& strays) {
  constexpr double kSamples = 30000.0, kBeyond = 0.001 / 6.0;  // share of the area at each side
  struct Triangle {
    Bounds bounds_ws;
    double area;
  };
  std::vector<Triangle> triangles;
  Bounds all = empty_bounds(), box, core = empty_bounds();
  double area = 0.0;
  for (const MeshInstance& part : parts) {
    const Mesh& mesh = scene.meshes[part.mesh];
    const glm::dmat4x3 world(world_from_mesh(mesh, part.instance));
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      const auto at = [&](size_t c) {
        return world * glm::dvec4(mesh.positions[mesh.indices[i + c]], 1.0);
      };
      const glm::dvec3 a = at(0), b = at(1), c = at(2);
      triangles.push_back({{glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))},
                           glm::length(glm::cross(b - a, c - a))});
      all = united(all, triangles.back().bounds_ws);
      area += triangles.back().area;
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> lows, highs;  // of triangles, as often as their area is large
    double sampled = 0.0, visited = 0.0;
    for (const Triangle& triangle : triangles) {
      for (visited += triangle.area; sampled < visited; sampled += area / kSamples) {
        lows.push_back(triangle.bounds_ws.low[axis]);
        highs.push_back(triangle.bounds_ws.high[axis]);
      }
    }
    box.low[axis] = percentile(std::move(lows), kBeyond);
    box.high[axis] = percentile(std::move(highs), 1.0 - kBeyond);
  }
  for (const Triangle& triangle : triangles) {
    const glm::vec3 low = glm::max(triangle.bounds_ws.low, box.low);
    const bool apart = glm::any(glm::lessThan(glm::min(triangle.bounds_ws.high, box.high), low));
    strays += apart ? 1 : 0;
    if (!apart) core = united(core, triangle.bounds_ws);
  }
  if (diagonal(core) < 0.9 * diagonal(all)) return core;
  strays = 0;
  return all;
}

// Returns a point from which most rays meet front faces, but which few rays from outside meet.
std::optional<glm::vec3> inside_of_room(const RayScene& rays, const Bounds& bounds) {
  constexpr int kRays = 64, kPoints = 27;
  constexpr float kShares[] = {0.5f, 0.25f, 0.75f};
  const auto reach = static_cast<float>(diagonal(bounds));
  for (int p = 0; p < kPoints; ++p) {
    const glm::vec3 share(kShares[p / 3 % 3], kShares[p % 3], kShares[p / 9]);
    const glm::vec3 at = bounds.low + share * size_of(bounds);
    int walls = 0, outsides = 0;
    for (int r = 0; r < kRays; ++r) {  // directions on a spiral
      const float y = 1.0f - (2.0f * static_cast<float>(r) + 1.0f) / kRays;
      const float angle = 2.4f * static_cast<float>(r), radius = std::sqrt(1.0f - y * y);
      const glm::vec3 to(radius * std::cos(angle), y, radius * std::sin(angle));
      const auto wall = rays.nearest(at, to, reach);
      const auto outside = rays.nearest(at + reach * to, -to, reach);
      walls += wall && wall->front && wall->distance > 0.02f * reach ? 1 : 0;
      outsides += outside && outside->front ? 1 : 0;
    }
    if (4 * walls >= 3 * kRays && 3 * outsides <= 2 * walls) return at;
  }
  return std::nullopt;
}

// Returns the least distance of the eye from the centre of a box at which the whole box is in view,
// with a margin of a tenth of the image. `back` is the unit vector from the centre to the eye.
float distance_in_view(const Bounds& bounds, const glm::vec3& back, float fov_y, double aspect) {
  const float up_limit = 0.9f * std::tan(0.5f * fov_y);
  const float right_limit = up_limit * static_cast<float>(aspect);
  const glm::vec3 right = glm::normalize(glm::cross(Camera().up_ws, back));
  float distance = 1e-6f;
  for (const glm::vec3& corner : corners_of(bounds)) {
    const glm::vec3 at = corner - middle(bounds);
    const float up = std::abs(glm::dot(at, glm::cross(back, right))) / up_limit;
    distance = std::max(
        distance, glm::dot(at, back) + std::max(up, std::abs(glm::dot(at, right)) / right_limit));
  }
  return distance;
}

}  // namespace

// The picture of a view at a low resolution. Depths are distances along the view axis.
struct ViewFinder::Picture {
  std::vector<float> depths;                    // of surfaces that are no sky
  float nearest = kInfinity;                    // depth of all surfaces
  size_t pixels = 0, surfaces = 0, fronts = 0;  // fronts: front faces of the subject
  size_t backs = 0;                             // pixels with nothing but faces that are not drawn
};

ViewFinder::ViewFinder(const Scene& scene) : scene_(scene), subject_ws_(scene.bounds_ws) {
  constexpr uint64_t kMostTriangles = uint64_t{1} << 23;
  constexpr size_t kMostSurroundings = 4;
  if (scene.meshes.empty() || triangle_count(scene) > kMostTriangles) return;
  if (auto rays = RayScene::create(scene, RayScene::Build::quick)) rays_ = std::move(*rays);
  std::vector<MeshInstance> parts = instances_of(scene.meshes);
  const auto width = [](const MeshInstance& part) { return size_of(part.bounds_ws).x; };
  std::ranges::stable_sort(parts, std::greater<>(), width);
  // The widest parts are left out if each is a sky or a ground of the others.
  for (size_t count = std::min(parts.size() - 1, kMostSurroundings);; --count) {
    size_t strays = 0, grounds = 0;
    subject_ws_ = bounds_without_strays(scene, Parts(parts).subspan(count), strays);
    skies_.clear();
    for (const MeshInstance& part : Parts(parts).first(count)) {
      if (is_ground(part.bounds_ws, subject_ws_))
        ++grounds;
      else if (rays_ && is_sky(*rays_, part, subject_ws_))
        skies_.push_back(part.mesh);
    }
    if (skies_.size() + grounds < count) continue;
    left_out_ =
        std::string(skies_.empty() ? "" : ", sky or room") + (grounds > 0 ? ", ground" : "");
    if (strays > 0) left_out_ += fmt::format(", stray triangles ({})", strays);
    if (!left_out_.empty())
      left_out_ = "The default view is framed without " + left_out_.substr(2) + ".";
    return;
  }
}

ViewFinder::Picture ViewFinder::look(const Camera& camera, double aspect) const {
  constexpr uint32_t kHeight = 72;
  Picture out;
  if (!rays_) return out;
  const auto width = static_cast<uint32_t>(std::clamp(std::round(kHeight * aspect), 16.0, 1024.0));
  const CameraMatrices matrices = camera_matrices(camera, width, kHeight);
  const glm::vec3 margin = 0.02f * size_of(subject_ws_);
  const Bounds subject{subject_ws_.low - margin, subject_ws_.high + margin};
  out.pixels = size_t{width} * kHeight;
  for (uint32_t i = 0; i < out.pixels; ++i) {
    const glm::uvec2 pixel(i % width, i / width);
    const Ray ray =
        camera_ray(matrices, camera.orthographic, glm::vec2(pixel) + 0.5f, width, kHeight);
    const float cosine = -glm::dot(ray.direction_ws, glm::vec3(matrices.world_from_view[2]));
    const glm::vec3 start = ray.origin_ws + ray.direction_ws * (camera.near_plane / cosine);
    const float far = (camera.far_plane - camera.near_plane) / cosine;
    const auto hit = rays_->nearest(start, ray.direction_ws, far);
    if (!hit) {
      out.backs += rays_->nearest(start, ray.direction_ws, far, true) ? 1 : 0;
      continue;
    }
    ++out.surfaces;
    const float depth = camera.near_plane + hit->distance * cosine;
    out.nearest = std::min(out.nearest, depth);
    if (std::ranges::find(skies_, hit->mesh) != skies_.end()) continue;
    out.depths.push_back(depth);
    out.fronts += hit->front && contains(subject, start + ray.direction_ws * hit->distance) ? 1 : 0;
  }
  return out;
}

Camera ViewFinder::framing_camera(double aspect) const {
  constexpr glm::vec3 kSides[] = {
      {0.6f, 0.45f, 0.85f}, {-0.85f, 0.45f, 0.6f}, {-0.6f, 0.45f, -0.85f}, {0.85f, 0.45f, -0.6f}};
  constexpr float kInside = 0.85f;  // of the distance to a sky or a wall
  const float kFovY = glm::radians(45.0f);
  const auto room = rays_ && skies_.empty() ? inside_of_room(*rays_, subject_ws_) : std::nullopt;
  Camera camera, best;
  camera.name = "frame";
  camera.origin = scene_.origin;
  camera.target_ws = room.value_or(middle(subject_ws_));
  camera.near_plane = 0.0f;
  camera.far_plane = kInfinity;
  camera.fit_planes = true;
  float most = -1.0f;
  for (const glm::vec3& side : kSides) {
    const glm::vec3 back = glm::normalize(room ? side * size_of(subject_ws_) : side);
    float free = kInfinity;
    for (const uint32_t sky : skies_)
      free = std::min(free, distance_to_shell(*rays_, sky, camera.target_ws, back).value_or(free));
    if (room) {
      const glm::vec3 wall = glm::mix(subject_ws_.low, subject_ws_.high, glm::step(0.0f, back));
      const glm::vec3 exit = (wall - *room) / back;
      const auto hit = rays_->nearest(*room, back, std::min({free, exit.x, exit.y, exit.z}));
      free = hit ? hit->distance : std::min({free, exit.x, exit.y, exit.z});
    }
    // An eye that cannot go back far enough sees more by a wider angle.
    const float whole = distance_in_view(subject_ws_, back, kFovY, aspect);
    const float distance = std::min(kInside * free, whole);
    camera.fov_y = distance < whole ? 1.45f * kFovY : kFovY;
    camera.eye_ws = camera.target_ws + distance * back;
    // An eye that is too near shows a large part of a subject that is cut off.
    const float score = distance * static_cast<float>(look(camera, aspect).fronts);
    if (score <= 1.25f * most) continue;
    best = camera;
    most = score;
  }
  return best;
}

Camera ViewFinder::with_fitted_planes(const Camera& camera, double aspect) const {
  const auto size = static_cast<float>(diagonal(subject_ws_));
  float reach = size;
  for (const glm::vec3& corner : corners_of(scene_.bounds_ws))
    reach = std::max(reach, 2.0f * size + glm::distance(corner, camera.eye_ws));
  Camera out = camera;
  out.near_plane = camera.orthographic ? -reach : 0.0f;
  out.far_plane = reach;
  if (!camera.orthographic)
    out.near_plane = std::clamp(0.5f * look(out, aspect).nearest, 2e-5f * size, 0.01f * size);
  const bool usable = camera.orthographic || out.near_plane > 0.0f;
  return usable && out.near_plane < out.far_plane ? out : camera;
}

RadiusChoice ViewFinder::radius(const Camera& camera, double aspect) const {
  const Picture picture = look(camera, aspect);
  RadiusChoice out{scene_.suggested_radius, "the scene suggests it", ""};
  if (out.radius <= 0.0f) {
    const float depth = picture.depths.empty() ? glm::distance(camera.eye_ws, camera.target_ws)
                                               : median(picture.depths);
    const float height =
        camera.orthographic ? camera.ortho_height : 2.0f * std::tan(0.5f * camera.fov_y) * depth;
    out.radius = 0.05f * height * static_cast<float>(aspect);
    out.reason = "a twentieth of the width of the view at the median distance of its surfaces";
  }
  if (picture.surfaces * 10 >= picture.pixels) return out;
  out.advice =
      picture.backs > picture.surfaces
          ? "The view shows back faces, which are not drawn: draw them by --both-sides, or "
      : picture.surfaces == 0 ? "The view shows nothing but sky: widen --near and --far, or "
                              : "Surfaces fill less than a tenth of the view: ";
  out.advice += "turn it with --eye and --target.";
  return out;
}

}  // namespace alcove::sample
