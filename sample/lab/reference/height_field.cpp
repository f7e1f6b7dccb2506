#include "reference/height_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "reference/sampling.h"

namespace alcove::sample {
namespace {

constexpr float kHalfPi = glm::half_pi<float>();

// A depth beyond every radius that is still finite, so that it can be multiplied by 0.
constexpr float kFarAway = 1e15f;

bool is_open(const HeightField& field, float value) {
  return field.orthographic ? value >= kFarAway : value <= 0.0f;
}

// Returns whether the surface is connected between two neighbouring texels with the values `a` and
// `b`. It is if the step between the two is at most three times the smaller of the steps on either
// side, or negligibly small. A value is an inverse depth, or a depth in orthographic views.
bool connected(float before, float a, float b, float after) {
  const float step = std::abs(b - a);
  const float around = std::min(std::abs(a - before), std::abs(after - b));
  return step <= 3.0f * around + 1e-4f * std::max(std::abs(a), std::abs(b));
}

void find_connections(HeightField& field) {
  const auto w = static_cast<int64_t>(field.width), h = static_cast<int64_t>(field.height);
  const auto at = [&](int64_t x, int64_t y) {
    return field.value[static_cast<size_t>(std::clamp<int64_t>(y, 0, h - 1) * w +
                                           std::clamp<int64_t>(x, 0, w - 1))];
  };
  const auto test = [&](int64_t x, int64_t y, int64_t dx, int64_t dy) {
    const float a = at(x, y), b = at(x + dx, y + dy);
    if (is_open(field, a) || is_open(field, b)) return false;
    // The surface is extrapolated linearly beyond the border of the image.
    const bool starts = x - dx < 0 || y - dy < 0, ends = x + 2 * dx >= w || y + 2 * dy >= h;
    const float after = ends ? 2.0f * b - a : at(x + 2 * dx, y + 2 * dy);
    const float before = starts ? a - (after - b) : at(x - dx, y - dy);
    return connected(before, a, b, after);
  };
  for (int64_t y = 0; y < h; ++y) {
    for (int64_t x = 0; x < w; ++x) {
      const auto i = static_cast<size_t>(y * w + x);
      if (x + 1 < w && test(x, y, 1, 0)) field.connected_right[i] = 1.0f;
      if (y + 1 < h && test(x, y, 0, 1)) field.connected_below[i] = 1.0f;
    }
  }
}

// The view-space position of a point of the image. `pixel` is in pixels, with texel centres at .5.
glm::vec3 view_position(const HeightField& field, glm::vec2 pixel, float value) {
  const glm::vec2 xy = field.scale * pixel + field.origin;
  if (field.orthographic) return {xy, -value};
  return glm::vec3(xy, -1.0f) / value;
}

// A direction in the image: a line from a pixel's centre that advances one texel per step along its
// major axis.
struct Walk {
  bool along_x;
  int step;     // +1 or -1 along the major axis
  float slope;  // texels along the minor axis per step
};

Walk walk_of(glm::vec2 direction) {
  const bool along_x = std::abs(direction.x) >= std::abs(direction.y);
  const float major = along_x ? direction.x : direction.y;
  const float minor = along_x ? direction.y : direction.x;
  return {along_x, major >= 0.0f ? 1 : -1, minor / std::abs(major)};
}

// A walk prepared for vectorised arithmetic. Step k is at `minor + slope k` on the minor axis, and
// the offset of its surface point is (ray + k ray_step + value * per_value), in perspective times
// value.
struct March {
  int steps;  // number of steps, all within the image
  float minor, slope;
  int first, major_stride, minor_stride;  // indices and strides in the field's arrays
  const float* value;
  const float* connected;
  glm::vec3 ray, ray_step, per_value;  // offset from the pixel's own surface point
  glm::vec3 view;
  float radius2;
  float radius2_value2;  // value^2 times this is added to radius2
};

// The number of steps until the walk leaves the image.
int steps_inside(float start, float slope, int major, int step, int major_size, int minor_size) {
  const int along = step > 0 ? major_size - 1 - major : major;
  if (slope == 0.0f) return along;
  const float room = slope > 0.0f ? static_cast<float>(minor_size - 1) - start : start;
  const float across = room / std::abs(slope);
  return std::min(along, static_cast<int>(std::min(across, static_cast<float>(along))));
}

March march_of(const HeightField& field, uint32_t x, uint32_t y, const Walk& walk,
               const glm::vec3& centre, const glm::vec3& view, float radius, int steps) {
  March m;
  const int width = static_cast<int>(field.width), height = static_cast<int>(field.height);
  const int major = static_cast<int>(walk.along_x ? x : y);
  const int major_size = walk.along_x ? width : height, minor_size = walk.along_x ? height : width;
  m.minor = static_cast<float>(walk.along_x ? y : x);
  m.slope = walk.slope;
  m.steps =
      std::min(steps, steps_inside(m.minor, walk.slope, major, walk.step, major_size, minor_size));
  m.major_stride = walk.step * (walk.along_x ? 1 : width);
  m.minor_stride = walk.along_x ? width : 1;
  m.first = major * (walk.along_x ? 1 : width);
  m.value = field.value.data();
  m.connected = walk.along_x ? field.connected_below.data() : field.connected_right.data();
  const glm::vec2 texel(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
  const auto along = static_cast<float>(walk.step);
  const glm::vec2 move = walk.along_x ? glm::vec2(along, walk.slope) : glm::vec2(walk.slope, along);
  const glm::vec2 ray = field.scale * texel + field.origin;
  m.ray_step = glm::vec3(field.scale * move, 0.0f);
  m.view = view;
  m.radius2 = radius * radius;
  m.radius2_value2 = 0.0f;
  if (field.orthographic) {
    m.ray = glm::vec3(ray, 0.0f) - centre;
    m.per_value = {0, 0, -1};
  } else {
    m.ray = glm::vec3(ray, -1.0f);
    m.per_value = -centre;
    std::swap(m.radius2, m.radius2_value2);
  }
  return m;
}

#if defined(__GNUC__) && defined(__x86_64__) && !defined(__clang__)
#define ALCOVE_WIDE __attribute__((target_clones("arch=haswell", "default")))
#else
#define ALCOVE_WIDE
#endif

constexpr int kBlock = 64;  // steps processed together

// Loads the values of `count` texels along the walk, from step `first` on. The loads are separate
// from the arithmetic, so that the compiler can vectorise the latter.
void load_values(const March m, int first, int count, float* values) {
  auto step = static_cast<float>(first);
  int texel = m.first + first * m.major_stride;
  for (int i = 0; i < count; ++i) {
    // Rounding may step outside the image by less than a texel, where the weight is zero.
    const float minor = m.minor + m.slope * step;
    const int low = static_cast<int>(minor);
    const float t = minor - static_cast<float>(low);
    const int at = texel + low * m.minor_stride;
    const float a = m.value[at];
    const float b = m.value[at + m.minor_stride];
    // Selection by weights replaces branches, which would be unpredictable.
    const float nearest = t >= 0.5f ? 1.0f : 0.0f;
    values[i] = a + (b - a) * (nearest + m.connected[at] * (t - nearest));
    step += 1.0f;
    texel += m.major_stride;
  }
}

// Computes two values for `count` steps of the walk, from step `first` on: the signed square of the
// cosine between the view direction and the direction to the surface, and the squared radius minus
// the squared distance of the surface.
ALCOVE_WIDE void squared_cosines(const March m, int first, int count, const float* values,
                                 float* __restrict cosines, float* __restrict slack) {
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<float>(first + i);
    const float value = values[i];
    const float qx = m.ray.x + at * m.ray_step.x + value * m.per_value.x;
    const float qy = m.ray.y + at * m.ray_step.y + value * m.per_value.y;
    const float qz = m.ray.z + value * m.per_value.z;
    const float distance2 = qx * qx + qy * qy + qz * qz + 1e-30f;
    const float towards = qx * m.view.x + qy * m.view.y + qz * m.view.z;
    const float within = m.radius2 + m.radius2_value2 * value * value;
    cosines[i] = towards * std::abs(towards) / distance2;
    slack[i] = within - distance2;
  }
}

// Returns the largest cosine between the view direction and the direction to a surface point within
// the radius, squared with its sign kept, or -1 if there is no such point. Comparing squares needs
// no square roots.
float squared_horizon(const March& m) {
  std::array<float, kBlock> values, cosines, slack;
  float best = -1.0f;
  for (int first = 1; first <= m.steps; first += kBlock) {
    const int count = std::min(kBlock, m.steps - first + 1);
    load_values(m, first, count, values.data());
    squared_cosines(m, first, count, values.data(), cosines.data(), slack.data());
    for (size_t i = 0; i < static_cast<size_t>(count); ++i)
      best = std::max(best, slack[i] >= 0.0f ? cosines[i] : -1.0f);
  }
  return best;
}

// Returns the number of texels that the occlusion radius spans along an axis of the image. No point
// within the radius is more texels away.
int steps_within(const HeightField& field, bool along_x, const glm::vec3& centre, float radius) {
  const float texel = std::abs(along_x ? field.scale.x : field.scale.y);
  const int most = static_cast<int>(along_x ? field.width : field.height);
  float extent = radius / texel;
  if (!field.orthographic) {
    // The silhouette of the sphere in the plane of this axis and the view axis.
    const float depth = -centre.z;
    const float side = std::abs(along_x ? centre.x : centre.y);
    const float distance2 = side * side + depth * depth;
    if (distance2 <= radius * radius) return most;
    const float middle = std::atan2(side, depth);
    const float half = std::asin(radius / std::sqrt(distance2));
    if (middle + half >= kHalfPi) return most;
    const float out = std::tan(middle + half) - std::tan(middle);
    const float in = std::tan(middle) - std::tan(middle - half);
    extent = std::max(out, in) / texel;
  }
  return static_cast<int>(std::min(std::ceil(extent), static_cast<float>(most)));
}

// The image-space direction, in pixels and not normalised, of a view-space direction at a point.
glm::vec2 image_direction(const HeightField& field, const glm::vec3& centre,
                          const glm::vec3& direction) {
  if (field.orthographic) return glm::vec2(direction) / field.scale;
  const float depth = -centre.z;
  return (glm::vec2(direction) * depth + glm::vec2(centre) * direction.z) / field.scale;
}

}  // namespace

HeightField make_height_field(const Image<float>& depth_vs, const Camera& camera) {
  HeightField field;
  field.width = depth_vs.width;
  field.height = depth_vs.height;
  field.orthographic = camera.orthographic;
  const glm::mat4 p = camera_matrices(camera, depth_vs.width, depth_vs.height).clip_from_view;
  // ndc = (P x + shift) / depth or P x + shift, and ndc = 2 pixel / size - 1, solved for x.
  const glm::vec2 focal(p[0][0], p[1][1]);
  const glm::vec2 shift = field.orthographic ? glm::vec2(p[3]) : -glm::vec2(p[2]);
  field.scale = 2.0f / (glm::vec2(field.width, field.height) * focal);
  field.origin = (-1.0f - shift) / focal;
  field.value.resize(depth_vs.pixels.size());
  field.connected_right.assign(depth_vs.pixels.size(), 0.0f);
  field.connected_below.assign(depth_vs.pixels.size(), 0.0f);
  for (size_t i = 0; i < depth_vs.pixels.size(); ++i) {
    const float depth = depth_vs.pixels[i];
    const bool surface = std::isfinite(depth) && (field.orthographic || depth > 0.0f);
    if (field.orthographic)
      field.value[i] = surface ? std::min(depth, kFarAway) : kFarAway;
    else
      field.value[i] = surface ? 1.0f / depth : 0.0f;
  }
  find_connections(field);
  // A walk along the last row or column reads beyond it, with a weight of zero.
  field.value.resize(field.value.size() + field.width + 1, 0.0f);
  return field;
}

bool is_sky(const HeightField& field, uint32_t x, uint32_t y) {
  return is_open(field, field.value[size_t{y} * field.width + x]);
}

FieldPoint field_point(const HeightField& field, uint32_t x, uint32_t y, float radius) {
  const float value = field.value[size_t{y} * field.width + x];
  const glm::vec2 middle(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
  FieldPoint point;
  point.x = x;
  point.y = y;
  point.centre = view_position(field, middle, value);
  point.view = field.orthographic ? glm::vec3(0, 0, 1) : -glm::normalize(point.centre);
  const Basis basis = make_basis(point.view);
  point.right = basis.x;
  point.up = basis.y;
  point.radius = radius;
  point.steps_x = steps_within(field, true, point.centre, radius);
  point.steps_y = steps_within(field, false, point.centre, radius);
  return point;
}

glm::vec3 across_view(const FieldPoint& point, float phi) {
  return std::cos(phi) * point.right + std::sin(phi) * point.up;
}

float horizon_angle(const HeightField& field, const FieldPoint& point, const glm::vec3& direction) {
  const Walk walk = walk_of(image_direction(field, point.centre, direction));
  const int steps = walk.along_x ? point.steps_x : point.steps_y;
  const float squared = squared_horizon(
      march_of(field, point.x, point.y, walk, point.centre, point.view, point.radius, steps));
  const float cosine = std::copysign(std::sqrt(std::abs(squared)), squared);
  return std::acos(std::clamp(cosine, -1.0f, 1.0f));
}

}  // namespace alcove::sample
