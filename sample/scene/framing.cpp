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

// From the middle of the subject to the eyes that are tried, not through edges of boxes.
constexpr glm::vec3 kSides[] = {
    {0.6f, 0.45f, 0.85f}, {-0.85f, 0.45f, 0.6f}, {-0.6f, 0.45f, -0.85f}, {0.85f, 0.45f, -0.6f}};

glm::vec3 size_of(const Bounds& bounds) { return bounds.high - bounds.low; }
glm::vec3 middle(const Bounds& bounds) { return 0.5f * bounds.low + 0.5f * bounds.high; }

bool is_wider(const Bounds& bounds, const Bounds& rest) {
  const glm::vec3 size = size_of(bounds), least = 3.0f * size_of(rest);
  return size.x >= least.x && size.z >= least.z;
}

bool is_ground(const Bounds& bounds, const Bounds& rest) {
  constexpr float kFlat = 0.005f;  // of the width; a circuit board is thicker
  const glm::vec3 size = size_of(bounds);
  return is_wider(bounds, rest) && size.y <= kFlat * std::min(size.x, size.z) &&
         bounds.high.y < middle(rest).y;
}

// Returns the first face that a ray from outside of a box, away from its middle, meets.
std::optional<Hit> beyond(const RayScene& rays, const Bounds& bounds, const glm::vec3& direction) {
  const float distance = 0.5f * static_cast<float>(diagonal(bounds));
  auto hit = rays.nearest(middle(bounds) + distance * direction, direction, kInfinity, true);
  if (hit) hit->distance += distance;
  return hit;
}

// A sky shows its front to all sides of the rest. A body with something inside shows its back.
bool is_sky(const RayScene& rays, const MeshInstance& part, const Bounds& rest) {
  return is_wider(part.bounds_ws, rest) && std::ranges::all_of(kSides, [&](const glm::vec3& side) {
           const auto hit = beyond(rays, rest, glm::normalize(side));
           return hit && hit->mesh == part.mesh && hit->front;
         });
}

// Returns the box of parts without strays, and counts the strays.
Bounds bounds_without_strays(const Scene& scene, Parts parts, size_t& strays) {
  constexpr double kSamples = 30000.0, kBeyond = 0.001 / 6.0;  // share of the area at each side
  std::vector<std::pair<Bounds, double>> triangles;            // with their areas
  Bounds all = empty_bounds(), box, core = empty_bounds();
  double area = 0.0, sampled = 0.0, visited = 0.0;
  for (const MeshInstance& part : parts) {
    const Mesh& mesh = scene.meshes[part.mesh];
    const glm::mat4x3 world = world_from_mesh(mesh, part.instance);
    const glm::dmat3 normal_from_mesh = cofactor(glm::mat3(world));
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      Bounds bounds = empty_bounds();
      for (size_t c = 0; c < 3; ++c) {
        const glm::vec3 at = world * glm::vec4(mesh.positions[mesh.indices[i + c]], 1.0f);
        bounds = united(bounds, {at, at});
      }
      triangles.emplace_back(bounds, glm::length(normal_from_mesh * area_of(mesh, i)));
      all = united(all, bounds);
      area += triangles.back().second;
    }
  }
  std::vector<glm::vec3> samples;  // middles of triangles, as often as their area is large
  for (const auto& [bounds, size] : triangles)
    for (visited += size; sampled < visited; sampled += area / kSamples)
      samples.push_back(middle(bounds));
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> values;
    values.reserve(samples.size());
    for (const glm::vec3& sample : samples) values.push_back(sample[axis]);
    box.low[axis] = percentile(values, kBeyond);
    box.high[axis] = percentile(values, 1.0 - kBeyond);
  }
  for (const auto& [bounds, size] : triangles) {
    const glm::vec3 low = glm::max(bounds.low, box.low), high = glm::min(bounds.high, box.high);
    const bool apart = glm::any(glm::lessThan(high, low));
    strays += apart ? 1 : 0;
    if (!apart) core = united(core, bounds);
  }
  if (diagonal(core) < 0.9 * diagonal(all)) return core;
  strays = 0;
  return all;
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
  std::vector<float> depths;  // of surfaces that are no sky
  float nearest = kInfinity;  // depth of all surfaces
  size_t pixels = 0, surfaces = 0;
  size_t fronts = 0, backs = 0;  // pixels by the side of the first face, drawn or not
};

ViewFinder::ViewFinder(const Scene& scene) : scene_(scene), subject_ws_(scene.bounds_ws) {
  constexpr uint64_t kMostTriangles = uint64_t{1} << 23;
  constexpr size_t kMostSurroundings = 4;
  if (scene.meshes.empty() || triangle_count(scene) > kMostTriangles) return;
  if (auto rays = RayScene::create(scene)) rays_ = std::move(*rays);
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
  out.pixels = size_t{width} * kHeight;
  for (uint32_t i = 0; i < out.pixels; ++i) {
    const glm::uvec2 pixel(i % width, i / width);
    const Ray ray =
        camera_ray(matrices, camera.orthographic, glm::vec2(pixel) + 0.5f, width, kHeight);
    const float cosine = -glm::dot(ray.direction_ws, glm::vec3(matrices.world_from_view[2]));
    const glm::vec3 start = ray.origin_ws + ray.direction_ws * (camera.near_plane / cosine);
    const float far = (camera.far_plane - camera.near_plane) / cosine;
    auto hit = rays_->nearest(start, ray.direction_ws, far, true);
    if (!hit) continue;
    ++(hit->front ? out.fronts : out.backs);
    hit = rays_->nearest(start, ray.direction_ws, far);
    if (!hit) continue;
    ++out.surfaces;
    const float depth = camera.near_plane + hit->distance * cosine;
    out.nearest = std::min(out.nearest, depth);
    if (std::ranges::find(skies_, hit->mesh) == skies_.end()) out.depths.push_back(depth);
  }
  return out;
}

Camera ViewFinder::framing_camera(double aspect) const {
  constexpr float kInside = 0.85f;  // of the distance to a sky or a wall
  const float kFovY = glm::radians(45.0f);
  Camera camera, best;
  camera.name = "frame";
  camera.origin = scene_.origin;
  camera.target_ws = middle(subject_ws_);
  camera.near_plane = 0.0f;
  camera.far_plane = kInfinity;
  camera.fit_planes = true;
  size_t fronts = 0, backs = 0;  // seen from outside
  for (const bool inside : {false, true}) {
    // The eye is in a room if those outside see backs of walls, and if it sees fronts there. A flat
    // subject has no inside.
    const glm::vec3 size = size_of(subject_ws_);
    const bool flat = std::min({size.x, size.y, size.z}) <= 0.005f * std::max(size.x, size.z);
    if (inside && (flat || !skies_.empty() || backs <= 2 * fronts)) break;
    float most = inside ? 0.0f : -1.0f;
    for (const glm::vec3& side : kSides) {
      const glm::vec3 back = glm::normalize(inside ? side * size_of(subject_ws_) : side);
      float free = kInfinity;
      if (inside) {
        free = 0.5f * static_cast<float>(diagonal(subject_ws_));
        if (const auto wall = rays_->nearest(camera.target_ws, back, free)) free = wall->distance;
      } else if (!skies_.empty()) {
        if (const auto sky = beyond(*rays_, subject_ws_, back)) free = sky->distance;
      }
      // An eye that cannot go back far enough sees more by a wider angle.
      const float whole = distance_in_view(subject_ws_, back, kFovY, aspect);
      camera.fov_y = kInside * free < whole ? 1.45f * kFovY : kFovY;
      camera.eye_ws = camera.target_ws + std::min(kInside * free, whole) * back;
      const Picture picture = look(camera, aspect);
      fronts += inside ? 0 : picture.fronts;
      backs += inside ? 0 : picture.backs;
      if (static_cast<float>(picture.fronts) <= 1.25f * most) continue;
      best = camera;
      most = static_cast<float>(picture.fronts);
    }
  }
  return best;
}

Camera ViewFinder::with_fitted_planes(const Camera& camera, double aspect) const {
  const auto size = static_cast<float>(diagonal(subject_ws_));
  if (size == 0.0f) return camera;
  Camera out = camera;
  out.far_plane = size;
  for (const glm::vec3& corner : corners_of(scene_.bounds_ws))
    out.far_plane = std::max(out.far_plane, 2.0f * size + glm::distance(corner, camera.eye_ws));
  out.near_plane = camera.orthographic ? -out.far_plane : 0.0f;
  if (!camera.orthographic)
    out.near_plane = std::clamp(0.5f * look(out, aspect).nearest, 2e-5f * size, 0.01f * size);
  return out;
}

RadiusChoice ViewFinder::radius(const Camera& camera, double aspect) const {
  Picture picture = look(camera, aspect);
  RadiusChoice out{scene_.suggested_radius, "the scene suggests it", ""};
  if (out.radius <= 0.0f) {
    if (picture.depths.empty())
      picture.depths.push_back(glm::distance(camera.eye_ws, camera.target_ws));
    const float height = camera.orthographic
                             ? camera.ortho_height
                             : 2.0f * std::tan(0.5f * camera.fov_y) * median(picture.depths);
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
