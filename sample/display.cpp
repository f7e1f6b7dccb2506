#include "display.h"

#include <algorithm>
#include <cmath>

#include "camera.h"

namespace alcove::sample {
namespace {

float encode_srgb(float linear) {
  const float x = std::clamp(linear, 0.0f, 1.0f);
  return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
}

}  // namespace

float exposure_of(const EnvironmentImage& environment) {
  const glm::vec3 mean = mean_radiance(environment);
  const float luminance = glm::dot(mean, glm::vec3(0.2126f, 0.7152f, 0.0722f));
  return luminance > 0.0f ? 0.9f / luminance : 1.0f;
}

Image<glm::vec3> display_colours(const Image<glm::vec3>& radiance, float exposure) {
  Image<glm::vec3> colours = radiance;
  for (glm::vec3& colour : colours.pixels) {
    for (int c = 0; c < 3; ++c) {
      colour[c] = encode_srgb(1.0f - std::exp(-exposure * colour[c]));
    }
  }
  return colours;
}

Image<glm::vec3> with_sky(const Rendering& rendering, Image<glm::vec3> picture) {
  const Camera& camera = rendering.camera;
  const Image<float> depth = linear_depth(rendering);
  const CameraMatrices matrices = camera_matrices(camera, picture.width, picture.height);
  for (std::uint32_t y = 0; y < picture.height; ++y) {
    for (std::uint32_t x = 0; x < picture.width; ++x) {
      if (!std::isfinite(depth.at(x, y))) {
        const Ray ray = camera_ray(matrices, camera.orthographic,
                                   {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f},
                                   picture.width, picture.height);
        picture.at(x, y) = radiance(rendering.light.environment, ray.direction_ws);
      }
    }
  }
  return picture;
}

}  // namespace alcove::sample
