#include "scene/framing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "support/median.h"

namespace alcove::sample {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr size_t kNearlyEmpty = 200;  // a view shows surfaces in less than one of so many pixels

// From the middle of the subject to the eyes that are tried, not through edges of boxes.
constexpr glm::vec3 kSides[] = {
    {0.6f, 0.45f, 0.85f}, {-0.85f, 0.45f, 0.6f}, {-0.6f, 0.45f, -0.85f}, {0.85f, 0.45f, -0.6f}};

glm::vec3 size_of(const Bounds& bounds) { return bounds.high - bounds.low; }
glm::vec3 middle(const Bounds& bounds) { return 0.5f * bounds.low + 0.5f * bounds.high; }

bool is_wider(const Bounds& bounds, const Bounds& rest) {
  const glm::vec3 size = size_of(bounds), least = 3.0f * size_of(rest);
  return size.x >= least.x && size.z >= least.z;
}

// Whether the box is flat and below the rest, as a ground or a tile of one is.
bool is_low(const Bounds& bounds, const Bounds& rest) {
  constexpr float kFlat = 0.005f;  // of the width; a circuit board is thicker
  const glm::vec3 size = size_of(bounds);
  return size.y <= kFlat * std::min(size.x, size.z) && bounds.high.y < middle(rest).y;
}

// Whether the face of a hit is drawn. The order of its vertices says nothing if both sides are.
bool is_drawn(const RayScene& rays, const Hit& hit) {
  return hit.front || rays.scene().materials[hit.material].double_sided;
}

// Returns the first face that a ray from outside of a box, away from its middle, meets.
std::optional<Hit> beyond(const RayScene& rays, const Bounds& bounds, const glm::vec3& direction) {
  const float distance = 0.5f * static_cast<float>(diagonal(bounds));
  auto hit = rays.nearest(middle(bounds) + distance * direction, direction, kInfinity, true);
  if (hit) hit->distance += distance;
  return hit;
}

// Whether meshes are the sky, or the shell of a room, of a rest. Nearly all rays away from the rest
// and upwards then meet a drawn face of theirs first, and far away. A sky may be open above if it
// is not drawn from outside, as a bowl is.
bool is_sky(const RayScene& rays, const std::vector<uint32_t>& meshes, const Bounds& rest) {
  constexpr int kRays = 32;
  const auto far = 2.0f * static_cast<float>(diagonal(rest));
  const auto outside = 2.0f * static_cast<float>(diagonal(rays.scene().bounds_ws));
  int missed = 0, missed_or_seen_from_outside = 0;
  for (int i = 0; i < kRays; ++i) {
    const float height = (static_cast<float>(i) + 0.5f) / kRays;
    const float across = std::sqrt(1.0f - height * height);
    const float angle = 2.4f * static_cast<float>(i);  // about the golden angle
    const glm::vec3 up(across * std::cos(angle), height, across * std::sin(angle));
    const auto hit = beyond(rays, rest, up);
    const bool met = hit && hit->distance >= far && is_drawn(rays, *hit) &&
                     std::ranges::find(meshes, hit->mesh) != meshes.end();
    missed += met ? 0 : 1;
    if (height > 0.4f) continue;  // 24 degrees
    const bool seen{rays.nearest(middle(rest) + outside * up, -up, outside - far)};
    missed_or_seen_from_outside += met && !seen ? 0 : 1;
  }
  return missed <= 3 || missed_or_seen_from_outside <= 1;
}

// The box of a triangle, and its area. A narrow triangle counts as a square of its width.
using Triangle = std::pair<Bounds, double>;

void add_triangles(const Scene& scene, const MeshInstance& part, std::vector<Triangle>& to) {
  const Mesh& mesh = scene.meshes[part.mesh];
  const glm::mat4x3 world = world_from_mesh(mesh, part.instance);
  const glm::dmat3 normal_from_mesh = cofactor(glm::mat3(world));
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    Bounds bounds = empty_bounds();
    for (size_t c = 0; c < 3; ++c) {
      const glm::vec3 at = world * glm::vec4(mesh.positions[mesh.indices[i + c]], 1.0f);
      bounds = united(bounds, {at, at});
    }
    const double area = glm::length(normal_from_mesh * area_of(mesh, i));
    const double width = 2.0 * area / std::max(diagonal(bounds), 1e-300);
    to.emplace_back(bounds, std::min(area, width * width));
  }
}

// Returns the value at a share of the sorted values of triangles, weighted by their areas.
template <class Value>
float quantile(std::span<const Triangle> triangles, double share, const Value& value) {
  constexpr double kSamples = 30000.0;
  double sum = 0.0, sampled = 0.0, visited = 0.0;
  for (const Triangle& triangle : triangles) sum += triangle.second;
  std::vector<float> values;
  for (const Triangle& triangle : triangles)
    for (visited += triangle.second; sampled < visited; sampled += sum / kSamples)
      values.push_back(value(triangle.first));
  return percentile(std::move(values), share);
}

// Returns the box of triangles without strays, and counts the strays.
Bounds bounds_without_strays(std::span<const Triangle> triangles, size_t& strays) {
  glm::vec3 median;
  for (int axis = 0; axis < 3; ++axis)
    median[axis] = quantile(triangles, 0.5, [axis](const Bounds& b) { return middle(b)[axis]; });
  const auto reach = [&](const Bounds& bounds) {
    return glm::length(glm::max(bounds.high - median, median - bounds.low));
  };
  const float most =
      std::min(30.0f * quantile(triangles, 0.5, reach), 1.5f * quantile(triangles, 0.999, reach));
  Bounds out = empty_bounds();
  strays = 0;
  for (const auto& [bounds, area] : triangles) {
    const bool stray = reach(bounds) > most;
    strays += stray ? 1 : 0;
    if (!stray) out = united(out, bounds);
  }
  return out;
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
  size_t drawn = 0, backs = 0;  // pixels whose first face is drawn, and whose first face is not
  std::set<uint32_t> meshes;    // in view

  // The more meshes and the fewer faces that are not drawn, the better.
  [[nodiscard]] float score() const {
    return static_cast<float>(meshes.size() * drawn) /
           static_cast<float>(std::max(drawn + backs, size_t{1}));
  }
};

ViewFinder::ViewFinder(const Scene& scene) : scene_(scene), subject_ws_(scene.bounds_ws) {
  constexpr uint64_t kMostTriangles = uint64_t{1} << 23;
  constexpr size_t kMostSurroundings = 8;
  if (scene.meshes.empty() || triangle_count(scene) > kMostTriangles) return;
  if (auto rays = RayScene::create(scene)) rays_ = std::move(*rays);
  std::vector<MeshInstance> parts = instances_of(scene.meshes);
  const auto width = [](const MeshInstance& part) {
    const glm::vec3 size = size_of(part.bounds_ws);
    return std::max(size.x, size.z);
  };
  std::ranges::stable_sort(parts, std::greater<>(), width);
  std::vector<Triangle> triangles;
  std::vector<size_t> starts;  // of the parts
  for (const MeshInstance& part : parts) {
    starts.push_back(triangles.size());
    add_triangles(scene, part, triangles);
  }
  size_t strays = 0, first = 0;
  bool has_ground = false;
  subject_ws_ = bounds_without_strays(triangles, strays);
  // From the outside in, the shortest run of the widest parts that surrounds the rest is left out.
  for (size_t end = 1; end < std::min(parts.size(), kMostSurroundings + 1); ++end) {
    size_t rest_strays = 0;
    const auto rest = bounds_without_strays(std::span(triangles).subspan(starts[end]), rest_strays);
    Bounds around = empty_bounds();
    std::vector<uint32_t> skies;
    for (const MeshInstance& part : std::span(parts).subspan(first, end - first)) {
      around = united(around, part.bounds_ws);
      if (!is_low(part.bounds_ws, rest)) skies.push_back(part.mesh);
    }
    if (!is_wider(around, rest) || !(skies.empty() || (rays_ && is_sky(*rays_, skies, rest))))
      continue;
    has_ground |= first + skies.size() < end;
    first = end;
    strays = rest_strays;
    subject_ws_ = rest;
    skies_.insert(skies_.end(), skies.begin(), skies.end());
  }
  left_out_ = std::string(skies_.empty() ? "" : ", sky or room") + (has_ground ? ", ground" : "");
  if (strays > 0) left_out_ += fmt::format(", stray triangles ({})", strays);
  if (!left_out_.empty())
    left_out_ = "The default view is framed without " + left_out_.substr(2) + ".";
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
    const bool drawn = is_drawn(*rays_, *hit);
    ++(drawn ? out.drawn : out.backs);
    if (!drawn) hit = rays_->nearest(start, ray.direction_ws, far);
    if (!hit) continue;
    ++out.surfaces;
    out.meshes.insert(hit->mesh);
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
  camera.name = kFrame;
  camera.origin = scene_.origin;
  camera.target_ws = middle(subject_ws_);
  camera.near_plane = 0.0f;
  camera.far_plane = kInfinity;
  camera.fit_planes = true;
  float most = -1.0f;
  size_t drawn = 0, backs = 0;
  for (const auto& [inside, from_above] : {std::pair(false, 1.0f), {true, 1.0f}, {false, -1.0f}}) {
    // A room has a ceiling, or from outside mostly back faces. The eye is only below if nothing is
    // seen otherwise.
    const bool is_room =
        rays_ && skies_.empty() &&
        (backs > 2 * drawn || rays_->nearest(camera.target_ws, camera.up_ws, kInfinity));
    if (inside ? !is_room : from_above < 0.0f && most > 0.1f) continue;
    for (glm::vec3 back : kSides) {
      back.y *= from_above;
      back = glm::normalize(inside ? back * size_of(subject_ws_) : back);
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
      drawn += picture.drawn;
      backs += picture.backs;
      // A room surrounds the eye.
      if (inside && picture.surfaces * 4 < picture.pixels * 3) continue;
      if (picture.score() <= 1.25f * most) continue;
      best = camera;
      most = picture.score();
    }
  }
  return best;
}

bool ViewFinder::shows_subject(const Camera& camera, double aspect) const {
  const Picture picture = look(camera, aspect);
  return !rays_ || picture.depths.size() * kNearlyEmpty >= picture.pixels;
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
  const bool framed = camera.name == kFrame && skies_.empty();
  const bool inside = framed && contains(subject_ws_, camera.eye_ws);
  const bool below = framed && camera.eye_ws.y < subject_ws_.low.y;
  const bool backs = picture.backs > 2 * picture.surfaces;
  if (!inside && !below && !backs && picture.surfaces * kNearlyEmpty >= picture.pixels) return out;
  out.advice =
      inside  ? "The view is from inside, because that shows more; to see the outside, draw back "
                "faces by --both-sides, or "
      : below ? "The view is from below, because back faces are not drawn: draw them by "
                "--both-sides, or "
      : backs ? "The view shows back faces, which are not drawn: draw them by --both-sides, or "
      : picture.surfaces == 0 ? "The view shows nothing but sky: widen --near and --far, or "
                              : "Surfaces fill hardly any of the view: ";
  out.advice += "turn it with --eye and --target.";
  return out;
}

}  // namespace alcove::sample
