#include "height_field_truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
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
  std::vector<float> value;   // 0 in the sky (perspective), infinity (orthographic)
  std::vector<uint8_t> join;  // bit 0: with x + 1, bit 1: with y + 1
  glm::vec2 scale;            // view x and y of a pixel at depth 1 (or any): scale * pixel + origin
  glm::vec2 origin;
  bool orthographic = false;
};

constexpr uint8_t kJoinRight = 1;
constexpr uint8_t kJoinBelow = 2;

bool is_open(const Field& field, float value) {
  return field.orthographic ? std::isinf(value) : value <= 0.0f;
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
    return joined(at(x - dx, y - dy), a, b, at(x + 2 * dx, y + 2 * dy));
  };
  for (int64_t y = 0; y < h; ++y) {
    for (int64_t x = 0; x < w; ++x) {
      uint8_t bits = 0;
      if (x + 1 < w && test(x, y, 1, 0)) bits |= kJoinRight;
      if (y + 1 < h && test(x, y, 0, 1)) bits |= kJoinBelow;
      field.join[static_cast<size_t>(y * w + x)] = bits;
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
  field.join.resize(depth_vs.pixels.size());
  for (size_t i = 0; i < depth_vs.pixels.size(); ++i) {
    const float depth = depth_vs.pixels[i];
    const bool surface = std::isfinite(depth) && (field.orthographic || depth > 0.0f);
    if (field.orthographic) {
      field.value[i] = surface ? depth : INFINITY;
    } else {
      field.value[i] = surface ? 1.0f / depth : 0.0f;
    }
  }
  find_joins(field);
  return field;
}

// Of a point of the image (pixels; a texel's centre is at .5) with the field's value there.
glm::vec3 view_position(const Field& field, glm::vec2 pixel, float value) {
  const glm::vec2 xy = field.scale * pixel + field.origin;
  if (field.orthographic) return {xy, -value};
  return glm::vec3(xy, -1.0f) / value;
}

// The surface on the line between two texels, `t` of the way from a to b.
float between(float a, float b, bool join, float t) {
  if (join) return a + t * (b - a);
  return t < 0.5f ? a : b;
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

// The largest cosine between the view vector and the direction to a point of the surface within the
// radius, along one walk; -1 where there is none.
float walk_horizon(const Field& field, uint32_t x, uint32_t y, const Walk& walk,
                   const glm::vec3& centre, const glm::vec3& view, float radius, int steps) {
  const int major_size = static_cast<int>(walk.along_x ? field.width : field.height);
  const int minor_size = static_cast<int>(walk.along_x ? field.height : field.width);
  const size_t major_stride = walk.along_x ? 1 : field.width;
  const size_t minor_stride = walk.along_x ? field.width : 1;
  const uint8_t join_bit = walk.along_x ? kJoinBelow : kJoinRight;
  int major = static_cast<int>(walk.along_x ? x : y);
  const float start = static_cast<float>(walk.along_x ? y : x);
  const float radius2 = radius * radius;
  float best = -1.0f;
  for (int k = 1; k <= steps; ++k) {
    major += walk.step;
    const float minor = start + walk.slope * static_cast<float>(k);
    if (major < 0 || major >= major_size || minor < -0.5f ||
        minor >= static_cast<float>(minor_size) - 0.5f) {
      break;
    }
    const int low = std::clamp(static_cast<int>(std::floor(minor)), 0, minor_size - 1);
    const int high = std::min(low + 1, minor_size - 1);
    const size_t row = static_cast<size_t>(major) * major_stride;
    const size_t a = row + static_cast<size_t>(low) * minor_stride;
    const size_t b = row + static_cast<size_t>(high) * minor_stride;
    const float t = std::max(minor - static_cast<float>(low), 0.0f);
    const float value = between(field.value[a], field.value[b], (field.join[a] & join_bit) != 0, t);
    if (is_open(field, value)) continue;
    const glm::vec2 pixel = walk.along_x ? glm::vec2(static_cast<float>(major), minor)
                                         : glm::vec2(minor, static_cast<float>(major));
    const glm::vec3 to = view_position(field, pixel + 0.5f, value) - centre;
    const float distance2 = glm::dot(to, to);
    if (distance2 > radius2 || distance2 <= 0.0f) continue;
    best = std::max(best, glm::dot(to, view) / std::sqrt(distance2));
  }
  return best;
}

// How many steps along the walk reach as far as a point of the radius's sphere can appear.
int steps_within(const Field& field, const Walk& walk, const glm::vec3& centre, float radius) {
  const float texel = std::abs(walk.along_x ? field.scale.x : field.scale.y);
  const int most = static_cast<int>(walk.along_x ? field.width : field.height);
  float reach = radius / texel;
  if (!field.orthographic) {
    // The silhouette of the sphere in the plane of this axis and the view axis.
    const float depth = -centre.z;
    const float side = std::abs(walk.along_x ? centre.x : centre.y);
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

// Five-point Gauss-Legendre over [a, b].
template <class Function>
void integrate(float a, float b, const Function& add) {
  constexpr std::array<float, 5> kNodes = {-0.9061798459f, -0.5384693101f, 0.0f, 0.5384693101f,
                                           0.9061798459f};
  constexpr std::array<float, 5> kWeights = {0.2369268851f, 0.4786286705f, 0.5688888889f,
                                             0.4786286705f, 0.2369268851f};
  const float half = 0.5f * (b - a), middle = 0.5f * (a + b);
  for (size_t i = 0; i < kNodes.size(); ++i) add(middle + half * kNodes[i], half * kWeights[i]);
}

struct Slice {
  float visible = 0.0f;
  float open = 0.0f;                 // what `visible` is with nothing in the way
  glm::vec2 bent = glm::vec2(0.0f);  // along the slice's direction and the view vector
};

// Angles from the view vector, positive along the slice's direction: the lit part of the slice lies
// from `low` to `high`, the hemisphere of the normal within a quarter turn of `tilt`.
Slice integrate_slice(float low, float high, float tilt) {
  Slice slice;
  const auto lit = [&](float angle, float weight) {
    const float w = weight * std::cos(angle - tilt) * std::abs(std::sin(angle));
    slice.visible += w;
    slice.bent += w * glm::vec2(std::sin(angle), std::cos(angle));
  };
  const auto all = [&](float angle, float weight) {
    slice.open += weight * std::cos(angle - tilt) * std::abs(std::sin(angle));
  };
  const float first = tilt - kHalfPi, last = tilt + kHalfPi;
  integrate(std::clamp(low, first, 0.0f), 0.0f, lit);
  integrate(0.0f, std::clamp(high, 0.0f, last), lit);
  integrate(first, 0.0f, all);
  integrate(0.0f, last, all);
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
      const int steps = steps_within(field, walk, centre, settings.radius);
      const float cosine = walk_horizon(field, x, y, walk, centre, view, settings.radius, steps);
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
