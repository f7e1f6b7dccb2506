#include "evaluate/motion_errors.h"

#include <array>
#include <cmath>

#include "support/parallel.h"

namespace alcove::sample {
namespace {

constexpr float kOffPlane = 0.005f;  // distance from the tangent plane over depth
constexpr float kMoving = 0.02f;     // pixels per frame

// The camera of a frame, for projecting in both directions.
struct Eye {
  CameraMatrices matrices;
  bool orthographic;
  glm::vec3 forward;
  std::uint32_t width;
  std::uint32_t height;

  explicit Eye(const RenderedFrame& frame)
      : matrices(camera_matrices(frame.camera, frame.depth.width, frame.depth.height)),
        orthographic(frame.camera.orthographic),
        forward(-glm::vec3(matrices.world_from_view[2])),
        width(frame.depth.width),
        height(frame.depth.height) {}

  glm::vec3 position(std::uint32_t x, std::uint32_t y, float depth) const {
    const Ray ray =
        camera_ray(matrices, orthographic,
                   {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}, width, height);
    return ray.origin_ws + ray.direction_ws * (depth / glm::dot(ray.direction_ws, forward));
  }
};

// The four texels around a point of an image that bilinear filtering reads.
struct Texels {
  std::array<std::int64_t, 2> first;
  glm::vec2 part;

  explicit Texels(glm::vec2 position_px) {
    const glm::vec2 corner = glm::floor(position_px - 0.5f);
    first = {static_cast<std::int64_t>(corner.x), static_cast<std::int64_t>(corner.y)};
    part = position_px - 0.5f - corner;
  }
  float weight(int i) const {
    return ((i & 1) != 0 ? part.x : 1.0f - part.x) * ((i >> 1) != 0 ? part.y : 1.0f - part.y);
  }
  // The index of texel i, -1 outside the image.
  template <class T>
  std::int64_t index(int i, const Image<T>& image) const {
    const std::int64_t x = first[0] + (i & 1);
    const std::int64_t y = first[1] + (i >> 1);
    const bool inside = x >= 0 && y >= 0 && x < image.width && y < image.height;
    return inside ? y * image.width + x : -1;
  }
};

constexpr glm::vec2 kNowhere(-1e6f);

glm::vec2 project(const Eye& eye, const glm::vec3& position_ws) {
  const glm::vec4 clip = eye.matrices.clip_from_world * glm::vec4(position_ws, 1.0f);
  if (!(clip.w > 1e-6f)) return kNowhere;
  const glm::vec2 px = (glm::vec2(clip) / clip.w * 0.5f + 0.5f) *
                       glm::vec2(static_cast<float>(eye.width), static_cast<float>(eye.height));
  // Positions are clamped to a little outside the image, so that their coordinates fit an integer.
  return glm::all(glm::lessThan(glm::abs(px), glm::vec2(1e6f))) ? px : kNowhere;
}

// The mask of the texels around `px` that show the surface through `position_ws`.
std::uint8_t same_surface(const Eye& eye, const RenderedFrame& before, glm::vec2 px,
                          const glm::vec3& position_ws, const glm::vec3& normal_ws) {
  const Texels texels(px);
  std::uint8_t found = 0;
  for (int i = 0; i < 4; ++i) {
    const std::int64_t index = texels.index(i, before.depth);
    if (index < 0 || !std::isfinite(before.depth.pixels[static_cast<std::size_t>(index)])) continue;
    const float depth = before.depth.pixels[static_cast<std::size_t>(index)];
    const glm::vec3 there =
        eye.position(static_cast<std::uint32_t>(index % before.depth.width),
                     static_cast<std::uint32_t>(index / before.depth.width), depth);
    if (std::abs(glm::dot(normal_ws, there - position_ws)) < kOffPlane * depth)
      found = static_cast<std::uint8_t>(found | 1u << static_cast<unsigned>(i));
  }
  return found;
}

}  // namespace

Reprojection reproject(const RenderedFrame& now, const RenderedFrame& before,
                       const PositionBefore& position_before) {
  const Eye eye(now);
  const Eye eye_before(before);
  Reprojection reprojection{{now.depth.width, now.depth.height, kNowhere},
                            {now.depth.width, now.depth.height}};
  parallel_rows(now.depth.height, [&](std::uint32_t y) {
    for (std::uint32_t x = 0; x < now.depth.width; ++x) {
      const float depth = now.depth.at(x, y);
      if (!std::isfinite(depth)) continue;
      const glm::vec3 position = eye.position(x, y, depth);
      // The normal is reprojected as the difference of two points, because `position_before` moves
      // points. They are close together, so that both belong to one object.
      const float length = 1e-3f * depth;
      const glm::vec3 was = position_before(position);
      const glm::vec3 tip = position_before(position - now.normal_ws.at(x, y) * length);
      const glm::vec3 normal = glm::normalize(was - tip);
      const glm::vec2 px = project(eye_before, was);
      reprojection.position_px.at(x, y) = px;
      reprojection.texels.at(x, y) = same_surface(eye_before, before, px, was, normal);
    }
  });
  return reprojection;
}

RunningMean& RunningMean::operator+=(const RunningMean& more) {
  sum += more.sum;
  count += more.count;
  return *this;
}

RunningMean visibility_change(const Image<float>& now, const Image<float>& before,
                              const Reprojection& reprojection) {
  RunningMean change;
  for (std::size_t pixel = 0; pixel < now.pixels.size(); ++pixel) {
    if (reprojection.texels.pixels[pixel] != kAllTexels) continue;
    const Texels texels(reprojection.position_px.pixels[pixel]);
    float then = 0.0f;
    for (int i = 0; i < 4; ++i)
      then += texels.weight(i) * before.pixels[static_cast<std::size_t>(texels.index(i, before))];
    change += {std::abs(now.pixels[pixel] - then), 1};
  }
  return change;
}

Mask surfaces_where(const RenderedFrame& seen,
                    const std::function<bool(const glm::vec3& position_ws)>& choose) {
  const Eye eye(seen);
  Mask mask(seen.depth.width, seen.depth.height);
  parallel_rows(mask.height, [&](std::uint32_t y) {
    for (std::uint32_t x = 0; x < mask.width; ++x) {
      const float depth = seen.depth.at(x, y);
      mask.at(x, y) = std::isfinite(depth) && choose(eye.position(x, y, depth)) ? 1 : 0;
    }
  });
  return mask;
}

RunningMean measure_speed(const Reprojection& reprojection) {
  RunningMean speed;
  for (std::size_t i = 0; i < reprojection.texels.pixels.size(); ++i) {
    if (reprojection.texels.pixels[i] == 0) continue;
    const auto width = static_cast<std::size_t>(reprojection.texels.width);
    const std::size_t row = i / width;
    const glm::vec2 here(static_cast<float>(i - row * width) + 0.5f,
                         static_cast<float>(row) + 0.5f);
    const float pixels = glm::distance(here, reprojection.position_px.pixels[i]);
    if (pixels > kMoving) speed += {pixels, 1};
  }
  return speed;
}

}  // namespace alcove::sample
