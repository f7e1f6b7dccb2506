#include "height_field_truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <utility>
#include <vector>

#include "parallel.h"

namespace alcove::sample {
namespace {

constexpr float kHalfPi = glm::half_pi<float>();

// The depth image as a surface: for every texel the inverse of its depth (perspective) or the depth
// itself (orthographic), either of which is linear across a flat face in the image; and whether the
// surface goes on to the next texel to the right and below.
//
// Between two texel centres that are joined the surface runs straight, so a plane is a plane; where
// they are not joined each texel is a column of its own width, as deep as you like.
struct Field {
  uint32_t width = 0, height = 0;
  std::vector<float> value;       // sky: 0 in perspective, kFarAway in orthographic views
  std::vector<float> join_right;  // 1: the surface goes on to (x + 1, y); 0: it does not
  std::vector<float> join_below;
  glm::vec2 scale;  // view x and y of a pixel at depth 1 (or any): scale * pixel + origin
  glm::vec2 origin;
  bool orthographic = false;
};

// Deeper than any radius reaches, and still finite, so that it can be multiplied by 0.
constexpr float kFarAway = 1e15f;

bool is_open(const Field& field, float value) {
  return field.orthographic ? value >= kFarAway : value <= 0.0f;
}

// Two texels are joined where the step between them is no more than three times the gentler of the
// steps on either side, or is too small to matter: a crease bends, an edge jumps.
bool joined(float before, float a, float b, float after) {
  const float step = std::abs(b - a);
  const float around = std::min(std::abs(a - before), std::abs(after - b));
  return step <= 3.0f * around + 1e-4f * std::max(std::abs(a), std::abs(b));
}

void find_joins(Field& field) {
  const auto w = static_cast<int64_t>(field.width), h = static_cast<int64_t>(field.height);
  const auto at = [&](int64_t x, int64_t y) {
    return field.value[static_cast<size_t>(std::clamp<int64_t>(y, 0, h - 1) * w +
                                           std::clamp<int64_t>(x, 0, w - 1))];
  };
  const auto test = [&](int64_t x, int64_t y, int64_t dx, int64_t dy) {
    const float a = at(x, y), b = at(x + dx, y + dy);
    if (is_open(field, a) || is_open(field, b)) return false;
    // Past the border of the image the surface is taken to go on as it does inside.
    const bool starts = x - dx < 0 || y - dy < 0, ends = x + 2 * dx >= w || y + 2 * dy >= h;
    const float after = ends ? 2.0f * b - a : at(x + 2 * dx, y + 2 * dy);
    const float before = starts ? a - (after - b) : at(x - dx, y - dy);
    return joined(before, a, b, after);
  };
  for (int64_t y = 0; y < h; ++y) {
    for (int64_t x = 0; x < w; ++x) {
      const auto i = static_cast<size_t>(y * w + x);
      if (x + 1 < w && test(x, y, 1, 0)) field.join_right[i] = 1.0f;
      if (y + 1 < h && test(x, y, 0, 1)) field.join_below[i] = 1.0f;
    }
  }
}

Field make_field(const Image<float>& depth_vs, const Camera& camera) {
  Field field;
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
  field.join_right.assign(depth_vs.pixels.size(), 0.0f);
  field.join_below.assign(depth_vs.pixels.size(), 0.0f);
  for (size_t i = 0; i < depth_vs.pixels.size(); ++i) {
    const float depth = depth_vs.pixels[i];
    const bool surface = std::isfinite(depth) && (field.orthographic || depth > 0.0f);
    if (field.orthographic) {
      field.value[i] = surface ? std::min(depth, kFarAway) : kFarAway;
    } else {
      field.value[i] = surface ? 1.0f / depth : 0.0f;
    }
  }
  find_joins(field);
  // What a walk along the last row or column reads beyond it.
  field.value.resize(field.value.size() + field.width + 1, 0.0f);
  return field;
}

// Of a point of the image (pixels; a texel's centre is at .5) with the field's value there.
glm::vec3 view_position(const Field& field, glm::vec2 pixel, float value) {
  const glm::vec2 xy = field.scale * pixel + field.origin;
  if (field.orthographic) return {xy, -value};
  return glm::vec3(xy, -1.0f) / value;
}

// One direction in the image: a line from a pixel's centre that moves one texel a step along its
// longer axis.
struct Walk {
  bool along_x;
  int step;     // +1 or -1 along the longer axis
  float slope;  // texels across per step
};

Walk walk_of(glm::vec2 direction) {
  const bool along_x = std::abs(direction.x) >= std::abs(direction.y);
  const float major = along_x ? direction.x : direction.y;
  const float minor = along_x ? direction.y : direction.x;
  return {along_x, major >= 0.0f ? 1 : -1, minor / std::abs(major)};
}

// A walk laid out as arithmetic: step k stands at `minor + slope k` across row or column k of the
// longer axis, and sees the point (ray + k ray_step + value * column), times value in perspective.
struct March {
  int steps;  // all of them within the image
  float minor, slope;
  int first, major_stride, minor_stride;  // of texels in the field's arrays
  const float* value;
  const float* join;
  glm::vec3 ray, ray_step, column;  // relative to the pixel's own point
  glm::vec3 view;
  float radius2;
  float radius2_value2;  // what value^2 times this adds to radius2
};

// Steps until the walk leaves the image.
int steps_inside(float start, float slope, int major, int step, int major_size, int minor_size) {
  const int along = step > 0 ? major_size - 1 - major : major;
  if (slope == 0.0f) return along;
  const float room = slope > 0.0f ? static_cast<float>(minor_size - 1) - start : start;
  const float across = room / std::abs(slope);
  return std::min(along, static_cast<int>(std::min(across, static_cast<float>(along))));
}

March march_of(const Field& field, uint32_t x, uint32_t y, const Walk& walk,
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
  m.join = walk.along_x ? field.join_below.data() : field.join_right.data();
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
    m.column = {0, 0, -1};
  } else {
    m.ray = glm::vec3(ray, -1.0f);
    m.column = -centre;
    std::swap(m.radius2, m.radius2_value2);
  }
  return m;
}

#if defined(__GNUC__) && defined(__x86_64__) && !defined(__clang__)
#define ALCOVE_WIDE __attribute__((target_clones("arch=haswell", "default")))
#else
#define ALCOVE_WIDE
#endif

constexpr int kBlock = 64;  // steps taken together

// The field's value at `count` steps from step `first` on. Loads only: what follows is arithmetic
// on whole registers.
void load_values(const March m, int first, int count, float* values) {
  auto step = static_cast<float>(first);
  int texel = m.first + first * m.major_stride;
  for (int i = 0; i < count; ++i) {
    // Rounding leaves the image by less than a texel, where nothing is joined, at no weight.
    const float minor = m.minor + m.slope * step;
    const int low = static_cast<int>(minor);
    const float t = minor - static_cast<float>(low);
    const int at = texel + low * m.minor_stride;
    const float a = m.value[at];
    const float b = m.value[at + m.minor_stride];
    // No branches: which way they go is as good as random.
    const float nearest = t >= 0.5f ? 1.0f : 0.0f;
    values[i] = a + (b - a) * (nearest + m.join[at] * (t - nearest));
    step += 1.0f;
    texel += m.major_stride;
  }
}

// For `count` steps from `first` on: the cosine between the view vector and the direction to the
// surface, times its size, and by how much the radius (squared) exceeds the distance.
ALCOVE_WIDE void squared_cosines(const March m, int first, int count, const float* values,
                                 float* __restrict cosines, float* __restrict slack) {
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<float>(first + i);
    const float value = values[i];
    const float qx = m.ray.x + at * m.ray_step.x + value * m.column.x;
    const float qy = m.ray.y + at * m.ray_step.y + value * m.column.y;
    const float qz = m.ray.z + value * m.column.z;
    const float distance2 = qx * qx + qy * qy + qz * qz + 1e-30f;
    const float towards = qx * m.view.x + qy * m.view.y + qz * m.view.z;
    const float within = m.radius2 + m.radius2_value2 * value * value;
    cosines[i] = towards * std::abs(towards) / distance2;
    slack[i] = within - distance2;
  }
}

// The largest cosine between the view vector and the direction to a point of the surface within the
// radius, times its size (which keeps the order and needs no root); -1 where there is none.
float squared_horizon(const March& m) {
  std::array<float, kBlock> values, cosines, slack;
  float best = -1.0f;
  for (int first = 1; first <= m.steps; first += kBlock) {
    const int count = std::min(kBlock, m.steps - first + 1);
    load_values(m, first, count, values.data());
    squared_cosines(m, first, count, values.data(), cosines.data(), slack.data());
    for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
      best = std::max(best, slack[i] >= 0.0f ? cosines[i] : -1.0f);
    }
  }
  return best;
}

// How many steps along an axis of the image reach as far as a point of the radius's sphere can
// appear.
int steps_within(const Field& field, bool along_x, const glm::vec3& centre, float radius) {
  const float texel = std::abs(along_x ? field.scale.x : field.scale.y);
  const int most = static_cast<int>(along_x ? field.width : field.height);
  float reach = radius / texel;
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
    reach = std::max(out, in) / texel;
  }
  return static_cast<int>(std::min(std::ceil(reach), static_cast<float>(most)));
}

// Sines and cosines at the five nodes of Gauss-Legendre over [a, b], by the addition theorem, and
// the weights.
struct Nodes {
  std::array<float, 5> sine, cosine, weight;
};
Nodes nodes_over(float a, float b) {
  constexpr std::array<float, 3> kPlaces = {0.0f, 0.5384693101f, 0.9061798459f};
  constexpr std::array<float, 3> kWeights = {0.5688888889f, 0.4786286705f, 0.2369268851f};
  const float half = 0.5f * (b - a), middle = 0.5f * (a + b);
  const float s = std::sin(middle), c = std::cos(middle);
  Nodes nodes{};
  nodes.sine[0] = s;
  nodes.cosine[0] = c;
  nodes.weight[0] = half * kWeights[0];
  for (size_t i = 1; i < kPlaces.size(); ++i) {
    const float ds = std::sin(half * kPlaces[i]), dc = std::cos(half * kPlaces[i]);
    for (size_t side = 0; side < 2; ++side) {
      const float turn = side == 0 ? ds : -ds;
      nodes.sine[2 * i - 1 + side] = s * dc + c * turn;
      nodes.cosine[2 * i - 1 + side] = c * dc - s * turn;
      nodes.weight[2 * i - 1 + side] = half * kWeights[i];
    }
  }
  return nodes;
}

struct Slice {
  float visible = 0.0f;
  float open = 0.0f;                 // what `visible` is with nothing in the way
  glm::vec2 bent = glm::vec2(0.0f);  // along the slice's direction and the view vector
};

// Angles from the view vector, positive along the slice's direction: the lit part of the slice lies
// from `low` to `high`, the hemisphere of the normal within a quarter turn of `tilt`.
Slice integrate_slice(float low, float high, float tilt) {
  const float first = tilt - kHalfPi, last = tilt + kHalfPi;
  const float tilt_sine = std::sin(tilt), tilt_cosine = std::cos(tilt);
  Slice slice;
  const auto weight_at = [&](const Nodes& nodes, size_t i) {
    return nodes.weight[i] * (nodes.cosine[i] * tilt_cosine + nodes.sine[i] * tilt_sine) *
           std::abs(nodes.sine[i]);
  };
  const auto add_lit = [&](const Nodes& nodes) {
    for (size_t i = 0; i < nodes.sine.size(); ++i) {
      const float w = weight_at(nodes, i);
      slice.visible += w;
      slice.bent += w * glm::vec2(nodes.sine[i], nodes.cosine[i]);
    }
  };
  const auto add_open = [&](const Nodes& nodes) {
    for (size_t i = 0; i < nodes.sine.size(); ++i) slice.open += weight_at(nodes, i);
  };
  add_lit(nodes_over(std::clamp(low, first, 0.0f), 0.0f));
  add_lit(nodes_over(0.0f, std::clamp(high, 0.0f, last)));
  if (low <= first && high >= last) {
    slice.open = slice.visible;
    return slice;
  }
  add_open(nodes_over(first, 0.0f));
  add_open(nodes_over(0.0f, last));
  return slice;
}

// What one pixel sees.
struct Pixel {
  float visibility = 1.0f;
  glm::vec3 bent_vs{0.0f};
};

// Two directions that with unit `v` make a right-handed frame.
std::array<glm::vec3, 2> across(const glm::vec3& v) {
  const glm::vec3 helper = std::abs(v.x) < 0.6f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  const glm::vec3 a = glm::normalize(glm::cross(helper, v));
  return {a, glm::cross(v, a)};
}

// Where a view-space direction at a point goes in the image, in pixels, not normalised.
glm::vec2 image_direction(const Field& field, const glm::vec3& centre, const glm::vec3& direction) {
  if (field.orthographic) return glm::vec2(direction) / field.scale;
  const float depth = -centre.z;
  return (glm::vec2(direction) * depth + glm::vec2(centre) * direction.z) / field.scale;
}

Pixel see(const Field& field, uint32_t x, uint32_t y, const glm::vec3& normal,
          const HeightFieldSettings& settings) {
  const float value = field.value[size_t{y} * field.width + x];
  const glm::vec2 middle(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
  const glm::vec3 centre = view_position(field, middle, value);
  const glm::vec3 view = field.orthographic ? glm::vec3(0, 0, 1) : -glm::normalize(centre);
  const auto [e1, e2] = across(view);
  // Every pixel turns its slices a little, so that no direction of the image is favoured.
  const float turn = static_cast<float>((x * 5u + y * 3u) % 8u) / 8.0f;
  const int steps_x = steps_within(field, true, centre, settings.radius);
  const int steps_y = steps_within(field, false, centre, settings.radius);
  float visible = 0.0f, open = 0.0f;
  glm::vec3 bent(0.0f);
  for (uint32_t s = 0; s < settings.slices; ++s) {
    const float phi =
        glm::pi<float>() * (static_cast<float>(s) + turn) / static_cast<float>(settings.slices);
    const glm::vec3 direction = std::cos(phi) * e1 + std::sin(phi) * e2;
    const glm::vec2 projected(glm::dot(normal, direction), glm::dot(normal, view));
    const float length = glm::length(projected);
    if (length < 1e-6f) continue;
    // A normal that faces away (an interpolated one may) is taken at the horizon.
    const float tilt = std::atan2(projected.x, std::max(projected.y, 0.0f));
    const glm::vec2 line = image_direction(field, centre, direction);
    std::array<float, 2> horizon;
    for (int side = 0; side < 2; ++side) {
      const Walk walk = walk_of(side == 0 ? line : -line);
      const int steps = walk.along_x ? steps_x : steps_y;
      const float squared =
          squared_horizon(march_of(field, x, y, walk, centre, view, settings.radius, steps));
      const float cosine = std::copysign(std::sqrt(std::abs(squared)), squared);
      horizon[static_cast<size_t>(side)] = std::acos(std::clamp(cosine, -1.0f, 1.0f));
    }
    const Slice slice = integrate_slice(-horizon[1], horizon[0], tilt);
    visible += length * slice.visible;
    open += length * slice.open;
    bent += length * (slice.bent.x * direction + slice.bent.y * view);
  }
  Pixel pixel;
  if (open > 0.0f) pixel.visibility = std::clamp(visible / open, 0.0f, 1.0f);
  const float length = glm::length(bent);
  pixel.bent_vs = length > 1e-6f ? bent / length : normal;
  return pixel;
}

}  // namespace

HeightFieldTruth height_field_truth(const Image<float>& depth_vs, const Image<glm::vec3>& normal_ws,
                                    const Camera& camera, const HeightFieldSettings& settings,
                                    const Progress& progress) {
  const Field field = make_field(depth_vs, camera);
  const CameraMatrices matrices = camera_matrices(camera, depth_vs.width, depth_vs.height);
  const glm::mat3 world_from_view(matrices.world_from_view);
  const glm::mat3 view_from_world(matrices.view_from_world);
  HeightFieldTruth out{{depth_vs.width, depth_vs.height, 1.0f},
                       {depth_vs.width, depth_vs.height, glm::vec3(0.0f)}};
  parallel_rows(
      depth_vs.height,
      [&](uint32_t y) {
        for (uint32_t x = 0; x < depth_vs.width; ++x) {
          const size_t i = size_t{y} * depth_vs.width + x;
          if (is_open(field, field.value[i]) || normal_ws.pixels[i] == glm::vec3(0.0f)) continue;
          const Pixel pixel = see(field, x, y, view_from_world * normal_ws.pixels[i], settings);
          out.visibility.pixels[i] = pixel.visibility;
          out.bent_normal_ws.pixels[i] = world_from_view * pixel.bent_vs;
        }
      },
      progress);
  return out;
}

}  // namespace alcove::sample
