#include "render/display.h"

#include <algorithm>
#include <cmath>

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
  for (glm::vec3& colour : colours.pixels)
    for (int c = 0; c < 3; ++c) colour[c] = encode_srgb(1.0f - std::exp(-exposure * colour[c]));
  return colours;
}

}  // namespace alcove::sample
