#include "scene/framing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace alcove::sample {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr uint32_t kPictureHeight = 90;  // pixels, of a depth picture

using Polygon = std::vector<glm::dvec3>;
using Triangle = std::array<glm::dvec3, 3>;

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

// Half the size of the image at distance 1, or of an orthographic view at any distance.
glm::dvec2 half_size(const Camera& camera, double aspect) {
  const double y = camera.orthographic ? 0.5 * camera.ortho_height : std::tan(0.5 * camera.fov_y);
  return {y * aspect, y};
}

// Returns the planes of the image's four sides in view space, and in perspective also the plane
// through the eye. The visible part of space is on their positive sides.
std::vector<glm::dvec4> side_planes(const Camera& camera, double aspect) {
  const auto [x, y] = std::pair(half_size(camera, aspect).x, half_size(camera, aspect).y);
  if (camera.orthographic) return {{1, 0, 0, x}, {-1, 0, 0, x}, {0, 1, 0, y}, {0, -1, 0, y}};
  return {{1, 0, -x, 0}, {-1, 0, -x, 0}, {0, 1, -y, 0}, {0, -1, -y, 0}, {0, 0, -1, 0}};
}

DepthRange united(const DepthRange& a, const DepthRange& b) {
  return {std::min(a.nearest, b.nearest), std::max(a.farthest, b.farthest)};
}

// Consecutive triangles of a mesh.
struct Block {
  size_t first;  // index
  size_t last;
  Bounds bounds;  // in mesh space
};

std::vector<Block> split(const Mesh& mesh) {
  constexpr size_t kIndices = size_t{3} << 16;
  std::vector<Block> blocks;
  const size_t count = mesh.indices.size() / 3 * 3;
  for (size_t first = 0; first < count; first += kIndices) {
    const size_t last = std::min(first + kIndices, count);
    blocks.push_back({first, last, bounds_of_triangles(mesh, first, last)});
  }
  return blocks;
}

// A block of an instance that may be in view.
struct Candidate {
  uint32_t mesh;
  uint32_t instance;
  uint32_t block;
  float nearest;  // a lower limit of its depth
};

// Draws the blocks in view, the nearest first, into a depth picture.
class DepthDrawing {
 public:
  DepthDrawing(const Scene& scene, const Camera& camera, double aspect)
      : scene_(scene),
        view_from_world_(camera_matrices(camera, 1, 1).view_from_world),
        perspective_(!camera.orthographic),
        planes_(side_planes(camera, aspect)),
        half_size_(half_size(camera, aspect)) {
    const double width = std::clamp(std::round(kPictureHeight * aspect), 16.0, 1024.0);
    depth_ = Image<float>(static_cast<uint32_t>(width), kPictureHeight,
                          std::numeric_limits<float>::infinity());
    for (const Mesh& mesh : scene.meshes) blocks_.push_back(split(mesh));
  }

  DepthPicture run() {
    std::vector<Candidate> candidates = candidates_in_view();
    std::ranges::sort(candidates, {}, &Candidate::nearest);
    constexpr uint64_t kMostTriangles = uint64_t{1} << 25;
    uint64_t triangles = 0;
    for (const Candidate& candidate : candidates) {
      const Block& block = blocks_[candidate.mesh][candidate.block];
      triangles += (block.last - block.first) / 3;
      const glm::dmat4 view = view_from_mesh(scene_.meshes[candidate.mesh], candidate.instance);
      if (triangles <= kMostTriangles)
        draw_block(scene_.meshes[candidate.mesh], block, view);
      else
        draw_bounds(block.bounds, view);
    }
    DepthPicture out{std::move(depth_), std::nullopt};
    if (range_.nearest <= range_.farthest) out.range = range_;
    return out;
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
          if (bounds) out.push_back({m, instance, b, static_cast<float>(bounds->nearest)});
        }
      }
    }
    return out;
  }

  void draw_block(const Mesh& mesh, const Block& block, const glm::dmat4& view) {
    const double side = glm::determinant(glm::dmat3(view)) < 0.0 ? -1.0 : 1.0;
    const bool culls = !scene_.materials[mesh.material].double_sided;
    for (size_t i = block.first; i < block.last; i += 3) {
      Triangle triangle;
      for (size_t c = 0; c < 3; ++c)
        triangle[c] = glm::dvec3(view * glm::dvec4(mesh.positions[mesh.indices[i + c]], 1.0));
      const auto& [a, b, c] = triangle;
      if (culls) {
        const glm::dvec3 normal = side * glm::cross(b - a, c - a);
        if (perspective_ ? glm::dot(normal, a) >= 0.0 : normal.z <= 0.0) continue;
      }
      if (is_outside(triangle)) continue;
      extend_range(triangle);
      draw(triangle);
    }
  }

  void draw_bounds(const Bounds& bounds, const glm::dmat4& view) {
    const auto depths = depth_bounds(bounds, view);
    if (!depths) return;
    range_ = united(range_, *depths);
    const glm::dvec3 centre(view * glm::dvec4(0.5f * (bounds.low + bounds.high), 1.0));
    set_pixel(to_pixel(homogeneous(centre)), -centre.z);
  }

  void extend_range(const Triangle& triangle) {
    const auto& [a, b, c] = triangle;
    const double nearest = -std::max({a.z, b.z, c.z}), farthest = -std::min({a.z, b.z, c.z});
    if (nearest >= range_.nearest && farthest <= range_.farthest) return;
    Polygon polygon(triangle.begin(), triangle.end());
    for (const glm::dvec4& plane : planes_) clip(polygon, plane);
    for (const glm::dvec3& p : polygon) range_ = united(range_, {-p.z, -p.z});
  }

  // A point of view space with the weight by which perspective divides.
  glm::dvec3 homogeneous(const glm::dvec3& p) const {
    return {p.x, p.y, perspective_ ? -p.z : 1.0};
  }
  // Returns the position in the image, in pixels from the top left corner.
  glm::dvec2 to_pixel(const glm::dvec3& point) const {
    const glm::dvec2 ndc = glm::dvec2(point) / point.z / half_size_;
    return {0.5 * (1.0 + ndc.x) * depth_.width, 0.5 * (1.0 - ndc.y) * depth_.height};
  }

  void set_pixel(const glm::dvec2& pixel, double depth) {
    if (!(pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < depth_.width && pixel.y < depth_.height) ||
        (perspective_ && depth <= 0.0))
      return;
    float& at = depth_.at(static_cast<uint32_t>(pixel.x), static_cast<uint32_t>(pixel.y));
    at = std::min(at, static_cast<float>(depth));
  }

  // Draws a triangle in homogeneous coordinates (Olano and Greer 1997), which need no clipping.
  void draw(const Triangle& triangle) {
    const glm::dvec3 p0 = homogeneous(triangle[0]), p1 = homogeneous(triangle[1]),
                     p2 = homogeneous(triangle[2]);
    glm::dvec2 low(0.0), high(depth_.width, depth_.height);
    if (p0.z > 0.0 && p1.z > 0.0 && p2.z > 0.0) {
      const glm::dvec2 a = to_pixel(p0), b = to_pixel(p1), c = to_pixel(p2);
      const glm::dvec2 first = glm::min(a, glm::min(b, c)), last = glm::max(a, glm::max(b, c));
      if (last.x - first.x < 1.0 && last.y - first.y < 1.0)
        return set_pixel((a + b + c) / 3.0, -(triangle[0].z + triangle[1].z + triangle[2].z) / 3.0);
      low = glm::max(low, glm::floor(first));
      high = glm::min(high, glm::ceil(last));
    }
    const glm::dvec3 e0 = glm::cross(p1, p2), e1 = glm::cross(p2, p0), e2 = glm::cross(p0, p1);
    for (double y = low.y + 0.5; y < high.y; ++y) {
      for (double x = low.x + 0.5; x < high.x; ++x) {
        const glm::dvec3 at((2.0 * x / depth_.width - 1.0) * half_size_.x,
                            (1.0 - 2.0 * y / depth_.height) * half_size_.y, 1.0);
        const double w0 = glm::dot(e0, at), w1 = glm::dot(e1, at), w2 = glm::dot(e2, at);
        const bool inside =
            (w0 >= 0.0 && w1 >= 0.0 && w2 >= 0.0) || (w0 <= 0.0 && w1 <= 0.0 && w2 <= 0.0);
        const double sum = w0 + w1 + w2;
        if (!inside || sum == 0.0) continue;
        set_pixel({x, y}, -(w0 * triangle[0].z + w1 * triangle[1].z + w2 * triangle[2].z) / sum);
      }
    }
  }

  const Scene& scene_;
  glm::dmat4 view_from_world_;
  bool perspective_;
  std::vector<glm::dvec4> planes_;
  glm::dvec2 half_size_;
  std::vector<std::vector<Block>> blocks_;  // by mesh
  Image<float> depth_;
  DepthRange range_{kInfinity, -kInfinity};
};

// Calls `visit(position_ws)` for each pixel of a depth picture that has a surface.
template <class Visit>
void for_each_surface(const DepthPicture& picture, const Camera& camera, double aspect,
                      const Visit& visit) {
  const glm::dmat4 world(camera_matrices(camera, 1, 1).world_from_view);
  const glm::dvec2 half = half_size(camera, aspect);
  for (uint32_t y = 0; y < picture.depth.height; ++y) {
    for (uint32_t x = 0; x < picture.depth.width; ++x) {
      const double depth = picture.depth.at(x, y);
      if (std::isinf(depth)) continue;
      const glm::dvec2 ndc((2.0 * x + 1.0) / picture.depth.width - 1.0,
                           1.0 - (2.0 * y + 1.0) / picture.depth.height);
      const glm::dvec2 at = ndc * half * (camera.orthographic ? 1.0 : depth);
      visit(glm::vec3(world * glm::dvec4(at, -depth, 1.0)));
    }
  }
}

// Returns the bounds of the subject, grown by the error of positions in a depth picture.
Bounds grown_subject(const Scene& scene) {
  const Bounds& bounds = scene.subject.bounds_ws;
  const auto margin = static_cast<float>(0.02 * diagonal(bounds));
  return {bounds.low - margin, bounds.high + margin};
}

// Returns the least distance of the eye from the centre of a box at which the whole box is in view,
// with a margin of a tenth of the image. `back` is the unit vector from the centre to the eye.
float distance_in_view(const Bounds& bounds, const glm::vec3& back, float fov_y, float aspect) {
  constexpr float kFilled = 0.9f;  // of the half-width and half-height of the image
  const float up_limit = kFilled * std::tan(0.5f * fov_y), right_limit = up_limit * aspect;
  const glm::vec3 right = glm::normalize(glm::cross(Camera().up_ws, back));
  const glm::vec3 up = glm::cross(back, right);
  const glm::vec3 centre = 0.5f * (bounds.low + bounds.high);
  float distance = 0.0f;
  for (const glm::vec3& corner : corners_of(bounds)) {
    const glm::vec3 at = corner - centre;
    distance = std::max({distance, glm::dot(at, back) + std::abs(glm::dot(at, up)) / up_limit,
                         glm::dot(at, back) + std::abs(glm::dot(at, right)) / right_limit});
  }
  return distance;
}

}  // namespace

DepthPicture draw_depth(const Scene& scene, const Camera& camera, double aspect) {
  return DepthDrawing(scene, camera, aspect).run();
}

Camera framing_camera(const Scene& scene, double aspect) {
  const Bounds& bounds = scene.subject.bounds_ws;
  const float radius = std::max(static_cast<float>(0.5 * diagonal(bounds)), 1e-6f);
  Camera camera;
  camera.name = "frame";
  camera.origin = scene.origin;
  camera.fov_y = glm::radians(45.0f);
  camera.target_ws = 0.5f * (bounds.low + bounds.high);
  camera.fit_planes = true;
  const Bounds grown = grown_subject(scene);
  Camera best = camera;
  double most = 0.0;  // share of the image that the subject would fill if all of it were in view
  for (size_t i = 0; i < kSidesOfSubject.size(); ++i) {
    constexpr float kInside =
        0.85f;  // of the distance at which a sky or a wall would be in the way
    constexpr double kEnough = 1.0 / 6.0;
    const glm::vec3 back = glm::normalize(kSidesOfSubject[i]);
    const float whole = distance_in_view(bounds, back, camera.fov_y, static_cast<float>(aspect));
    const float distance =
        std::min(std::max(whole, 0.1f * radius), kInside * scene.subject.free_distance_ws[i]);
    camera.eye_ws = camera.target_ws + distance * back;
    camera.near_plane = 0.02f * distance;
    camera.far_plane =
        distance + 4.0f * std::max(radius, static_cast<float>(diagonal(scene.bounds_ws)));
    const DepthPicture picture = draw_depth(scene, camera, aspect);
    size_t pixels = 0;
    for_each_surface(picture, camera, aspect,
                     [&](const glm::vec3& at) { pixels += contains(grown, at); });
    // An eye that is too near shows a large part of a subject that is cut off.
    const double nearness = std::min(1.0, static_cast<double>(distance) / whole);
    const double share = nearness * nearness * static_cast<double>(pixels) /
                         static_cast<double>(picture.depth.pixels.size());
    // A later side has to show clearly more.
    if (i == 0 || share > 1.25 * most) {
      best = camera;
      most = share;
    }
    if (most > kEnough) break;
  }
  return best;
}

Camera with_fitted_planes(const Scene& scene, const Camera& camera, double aspect) {
  const auto range = draw_depth(scene, camera, aspect).range;
  if (!range) return camera;
  Camera out = camera;
  const double size = diagonal(scene.subject.bounds_ws);
  // The margin covers the rounding of positions and planes, which are floats.
  const double margin = 1e-3 * std::max(size, range->farthest - range->nearest);
  if (camera.orthographic) {
    out.near_plane = static_cast<float>(range->nearest - margin);
    out.far_plane = static_cast<float>(range->farthest + margin);
  } else {
    // The far plane must also be far enough for other positions and directions of the camera within
    // the subject.
    double farthest = range->farthest;
    for (const glm::vec3& corner : corners_of(scene.subject.bounds_ws))
      farthest = std::max(farthest, double(glm::distance(corner, camera.eye_ws)) + 2.0 * size);
    const double least = std::max(2e-4 * size, 1e-6 * farthest);
    out.near_plane =
        static_cast<float>(std::max(std::min(0.5 * range->nearest, 0.01 * size), least));
    out.far_plane = static_cast<float>(std::max(farthest + margin, 2.0 * out.near_plane));
  }
  return out.near_plane < out.far_plane ? out : camera;
}

RadiusChoice radius_for_view(const Scene& scene, const Camera& camera, double aspect) {
  constexpr double kShare = 0.05;     // of the extent of the surfaces in view
  constexpr size_t kLeastShown = 50;  // one pixel in so many shows the subject
  if (scene.suggested_radius > 0.0f) return {scene.suggested_radius, "the scene suggests it"};
  const DepthPicture picture = draw_depth(scene, camera, aspect);
  const Bounds grown = grown_subject(scene);
  // Coordinates by axis, and distances from the eye.
  std::array<std::vector<float>, 4> all, subject;
  for_each_surface(picture, camera, aspect, [&](const glm::vec3& at) {
    const glm::vec4 values(at, glm::distance(at, camera.eye_ws));
    for (int c = 0; c < 4; ++c) {
      all[static_cast<size_t>(c)].push_back(values[c]);
      if (contains(grown, at)) subject[static_cast<size_t>(c)].push_back(values[c]);
    }
  });
  if (all[0].empty())
    return {default_radius(scene), "a twentieth of the size of the subject: no surface is in view"};
  const bool shows_subject = subject[0].size() * kLeastShown >= picture.depth.pixels.size();
  auto& values = shows_subject ? subject : all;
  for (std::vector<float>& one : values) std::ranges::sort(one);
  const auto quantile = [&](size_t which, double share) {
    const std::vector<float>& sorted = values[which];
    return double{sorted[static_cast<size_t>(share * static_cast<double>(sorted.size() - 1))]};
  };
  // The central nine tenths of the pixels have nine tenths of the extent.
  constexpr double kCentral = 0.9;
  glm::dvec3 extent(0.0);
  for (size_t c = 0; c < 3; ++c) {
    extent[static_cast<int>(c)] =
        (quantile(c, 0.5 + 0.5 * kCentral) - quantile(c, 0.5 - 0.5 * kCentral)) / kCentral;
  }
  RadiusChoice choice{static_cast<float>(kShare * glm::length(extent)),
                      shows_subject ? "a twentieth of the extent of the part of the subject in view"
                                    : "a twentieth of the extent of the surfaces in view"};
  constexpr float kWhole = 0.7f;  // of the extent of the subject: the view shows it as a whole
  const auto whole = static_cast<float>(kShare * diagonal(scene.subject.bounds_ws));
  if (!(choice.radius > 0.0f) || (shows_subject && choice.radius > kWhole * whole))
    choice = {default_radius(scene), "a twentieth of the size of the subject"};
  // A larger radius would cover most of the image.
  constexpr double kMostOfDistance = 0.25;
  const double most = kMostOfDistance * quantile(3, 0.5);
  if (!camera.orthographic && most > 0.0 && choice.radius > most)
    choice = {static_cast<float>(most), "a quarter of the median distance of the surfaces in view"};
  return choice;
}

}  // namespace alcove::sample
