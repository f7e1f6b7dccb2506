#include "evaluate/motion_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "support/median.h"
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

bool in_image(glm::vec2 position_px, std::uint32_t width, std::uint32_t height) {
  return position_px.x >= 0.0f && position_px.y >= 0.0f &&
         position_px.x <= static_cast<float>(width) && position_px.y <= static_cast<float>(height);
}

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

// The texel of the same surface with the largest bilinear weight.
std::size_t nearest_texel(const Reprojection& reprojection, std::size_t pixel,
                          const Image<Age>& before) {
  const Texels texels(reprojection.position_px.pixels[pixel]);
  std::size_t nearest = 0;
  float most = -1.0f;
  for (int i = 0; i < 4; ++i) {
    if ((reprojection.texels.pixels[pixel] >> i & 1) != 0 && texels.weight(i) > most) {
      most = texels.weight(i);
      nearest = static_cast<std::size_t>(texels.index(i, before));
    }
  }
  return nearest;
}

// The change since the previous frame at a pixel whose four previous texels show its surface.
double change_at(std::size_t pixel, const Image<float>& now, const Image<float>& before,
                 const Reprojection& reprojection) {
  const Texels texels(reprojection.position_px.pixels[pixel]);
  float then = 0.0f;
  for (int i = 0; i < 4; ++i)
    then += texels.weight(i) * before.pixels[static_cast<std::size_t>(texels.index(i, before))];
  return now.pixels[pixel] - then;
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

Image<Age> first_ages(const RenderedFrame& now) {
  Image<Age> ages(now.depth.width, now.depth.height);
  for (std::size_t i = 0; i < ages.pixels.size(); ++i)
    ages.pixels[i].frames = std::isfinite(now.depth.pixels[i]) ? 1 : 0;
  return ages;
}

Image<Age> next_ages(const RenderedFrame& now, const Reprojection& reprojection,
                     const Image<Age>& before) {
  Image<Age> ages = first_ages(now);
  for (std::size_t i = 0; i < ages.pixels.size(); ++i) {
    if (reprojection.texels.pixels[i] != 0) {
      const Age& age = before.pixels[nearest_texel(reprojection, i, before)];
      ages.pixels[i] = {age.frames + 1, age.uncovered};
    } else if (ages.pixels[i].frames > 0) {
      ages.pixels[i].uncovered =
          in_image(reprojection.position_px.pixels[i], before.width, before.height);
    }
  }
  return ages;
}

RunningMean& RunningMean::operator+=(const RunningMean& more) {
  sum += more.sum;
  count += more.count;
  return *this;
}

RunningMean visibility_change(const Image<float>& now, const Image<float>& before,
                              const Reprojection& reprojection) {
  RunningMean change;
  for (std::size_t pixel = 0; pixel < now.pixels.size(); ++pixel)
    if (reprojection.texels.pixels[pixel] == kAllTexels)
      change += {std::abs(change_at(pixel, now, before, reprojection)), 1};
  return change;
}

RunningMean change_lower_bound(const SplitTruth<float>& now, const SplitTruth<float>& before,
                               const Reprojection& reprojection) {
  const auto in_direction = [](double change, double other) {
    return other == 0.0 ? 0.0 : std::copysign(change, change * other);
  };
  RunningMean least;
  for (std::size_t pixel = 0; pixel < now.first.pixels.size(); ++pixel) {
    if (reprojection.texels.pixels[pixel] == kAllTexels) {
      const double first = change_at(pixel, now.first, before.first, reprojection);
      const double second = change_at(pixel, now.second, before.second, reprojection);
      least += {0.5 * (in_direction(first, second) + in_direction(second, first)), 1};
    }
  }
  return least;
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

Speed measure_speed(const Reprojection& reprojection) {
  std::vector<float> speeds;
  RunningMean mean;
  for (std::size_t i = 0; i < reprojection.texels.pixels.size(); ++i) {
    if (reprojection.texels.pixels[i] == 0) continue;
    const auto width = static_cast<std::size_t>(reprojection.texels.width);
    const std::size_t row = i / width;
    const glm::vec2 here(static_cast<float>(i - row * width) + 0.5f,
                         static_cast<float>(row) + 0.5f);
    const float speed = glm::distance(here, reprojection.position_px.pixels[i]);
    if (speed > kMoving) {
      speeds.push_back(speed);
      mean += {speed, 1};
    }
  }
  return {mean.mean(), percentile(std::move(speeds), 0.95)};
}

Image<float> mean_image(const SplitTruth<float>& truth) {
  Image<float> mean = truth.first;
  for (std::size_t i = 0; i < mean.pixels.size(); ++i)
    mean.pixels[i] = 0.5f * (truth.first.pixels[i] + truth.second.pixels[i]);
  return mean;
}

RunningMean squared_error(const Image<float>& result, const SplitTruth<float>& truth,
                          const Mask& mask) {
  RunningMean squares;
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
    if (mask.pixels[i] == 0) continue;
    const double first = truth.first.pixels[i];
    const double second = truth.second.pixels[i];
    const double given = result.pixels[i];
    const double error = std::isfinite(given) ? given - 0.5 * (first + second) : 1.0;
    const double noise = 0.5 * (first - second);
    squares.sum += error * error - noise * noise;
    ++squares.count;
  }
  return squares;
}

RunningMean squared_error(const Image<glm::vec3>& result, const SplitTruth<glm::vec3>& truth,
                          const Mask& mask) {
  RunningMean squares;
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
    if (mask.pixels[i] == 0) continue;
    const glm::dvec3 given(result.pixels[i]);
    const double length = glm::length(given);
    const glm::dvec3 first(truth.first.pixels[i]);
    const glm::dvec3 second(truth.second.pixels[i]);
    // The noise of the halves is independent, so its product vanishes in the mean.
    squares.sum += length > 0.0 && std::isfinite(length)
                       ? glm::dot(given / length - first, given / length - second)
                       : 2.0;
    ++squares.count;
  }
  return squares;
}

double root(const RunningMean& squares) { return std::sqrt(std::max(squares.mean(), 0.0)); }

}  // namespace alcove::sample
