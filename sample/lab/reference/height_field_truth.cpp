#include "reference/height_field_truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "reference/height_field.h"
#include "support/parallel.h"

namespace alcove::sample {
namespace {

constexpr float kHalfPi = glm::half_pi<float>();

// The five nodes of Gauss-Legendre quadrature over [a, b]: their sines and cosines, computed by the
// addition theorem, and their weights.
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
      const float signed_sine = side == 0 ? ds : -ds;
      nodes.sine[2 * i - 1 + side] = s * dc + c * signed_sine;
      nodes.cosine[2 * i - 1 + side] = c * dc - s * signed_sine;
      nodes.weight[2 * i - 1 + side] = half * kWeights[i];
    }
  }
  return nodes;
}

struct Slice {
  float visible = 0.0f;
  float open = 0.0f;                 // value of `visible` without occluders
  glm::vec2 bent = glm::vec2(0.0f);  // along the slice's direction and the view direction
};

// Integrates a slice that is visible from angle `low` to `high`. The hemisphere of the normal is
// within 90 degrees of `tilt`. Angles are from the view direction, positive along the slice's
// direction.
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

// The result for one pixel.
struct Pixel {
  float visibility = 1.0f;
  glm::vec3 bent_vs{0.0f};
};

Pixel see(const HeightField& field, uint32_t x, uint32_t y, const glm::vec3& normal,
          const HeightFieldSettings& settings) {
  const FieldPoint point = field_point(field, x, y, settings.radius);
  // The slices are rotated differently in each pixel, so that no direction of the image is
  // favoured.
  const float rotation = static_cast<float>((x * 5u + y * 3u) % 8u) / 8.0f;
  float visible = 0.0f, open = 0.0f;
  glm::vec3 bent(0.0f);
  for (uint32_t s = 0; s < settings.slices; ++s) {
    const float phi =
        glm::pi<float>() * (static_cast<float>(s) + rotation) / static_cast<float>(settings.slices);
    const glm::vec3 direction = across_view(point, phi);
    const glm::vec2 projected(glm::dot(normal, direction), glm::dot(normal, point.view));
    const float length = glm::length(projected);
    if (length < 1e-6f) continue;
    // A normal that faces away, as an interpolated one may, is clamped to 90 degrees.
    const float tilt = std::atan2(projected.x, std::max(projected.y, 0.0f));
    const Slice slice = integrate_slice(-horizon_angle(field, point, -direction),
                                        horizon_angle(field, point, direction), tilt);
    visible += length * slice.visible;
    open += length * slice.open;
    bent += length * (slice.bent.x * direction + slice.bent.y * point.view);
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
  const HeightField field = make_height_field(depth_vs, camera);
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
          if (is_sky(field, x, y) || normal_ws.pixels[i] == glm::vec3(0.0f)) continue;
          const Pixel pixel = see(field, x, y, view_from_world * normal_ws.pixels[i], settings);
          out.visibility.pixels[i] = pixel.visibility;
          out.bent_normal_ws.pixels[i] = world_from_view * pixel.bent_vs;
        }
      },
      progress);
  return out;
}

}  // namespace alcove::sample
