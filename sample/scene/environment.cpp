#include "scene/environment.h"

#include <stb_image.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/gtc/constants.hpp>
#include <memory>

#include "support/image_io.h"

namespace alcove::sample {
namespace {

using Loaded = tl::expected<EnvironmentImage, std::string>;

constexpr int kLargest = 32768;      // pixels a side of a file
constexpr uint32_t kColumns = 2048;  // that are kept

glm::vec3 direction_of(double u, double v) {
  const double turn = u * 2.0 * glm::pi<double>(), fall = v * glm::pi<double>();
  return glm::vec3(std::sin(fall) * std::sin(turn), std::cos(fall),
                   -std::sin(fall) * std::cos(turn));
}

glm::vec3 sky_radiance(const glm::vec3& d) {
  const glm::vec3 sun = glm::normalize(glm::vec3(-0.55f, 0.5f, 0.65f));
  const float near_sun = glm::dot(d, sun) - 1.0f;
  const float height = std::max(d.y, 0.0f);
  const glm::vec3 zenith(0.35f, 0.65f, 1.3f), horizon(1.3f, 1.35f, 1.4f), ground(0.3f, 0.25f, 0.2f);
  const glm::vec3 haze = glm::mix(zenith, horizon, std::exp(-4.0f * height));
  const glm::vec3 glow = 9.0f * std::exp(40.0f * near_sun) * glm::vec3(1.0f, 0.85f, 0.6f) +
                         1.2f * std::exp(5.0f * near_sun) * glm::vec3(1.0f, 0.9f, 0.75f);
  const float above = glm::smoothstep(-0.04f, 0.04f, d.y);
  return glm::mix(ground, haze + glow, above);
}

Loaded refuse(const std::filesystem::path& file, const std::string& why) {
  return tl::unexpected("The environment " + file.string() + " cannot be used: " + why + ".");
}

uint64_t size_of(const std::filesystem::path& file) {
  std::error_code ignored;
  const auto size = std::filesystem::file_size(file, ignored);
  return ignored ? 0 : size;
}

// Of a Radiance file: rows of at least 8 pixels may be coded as runs of up to 127 a channel.
uint64_t least_bytes(int width, int height) {
  const auto w = static_cast<uint64_t>(width), h = static_cast<uint64_t>(height);
  return w < 8 ? 4 * w * h : h * (4 + 8 * ((w + 126) / 127));
}

Loaded load_hdr(const std::filesystem::path& file) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> opened(std::fopen(file.c_str(), "rb"),
                                                               std::fclose);
  if (!opened) return refuse(file, "it cannot be opened");
  int width = 0, height = 0, channels = 0;
  if (stbi_is_hdr_from_file(opened.get()) == 0 ||
      stbi_info_from_file(opened.get(), &width, &height, &channels) == 0) {
    return refuse(file, "it is no Radiance file");
  }
  const bool in_range = width >= 1 && height >= 1 && width <= kLargest && height <= kLargest;
  if (!in_range || least_bytes(width, height) > size_of(file)) {
    return refuse(file, "it says " + std::to_string(width) + "x" + std::to_string(height) +
                            " pixels, but is too short for that");
  }
  const std::unique_ptr<float, void (*)(void*)> pixels(
      stbi_loadf_from_file(opened.get(), &width, &height, &channels, 3), stbi_image_free);
  if (!pixels) return refuse(file, "it is damaged");
  EnvironmentImage image(static_cast<uint32_t>(width), static_cast<uint32_t>(height));
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = {pixels.get()[3 * i], pixels.get()[3 * i + 1], pixels.get()[3 * i + 2]};
  }
  return image;
}

void make_light(EnvironmentImage& image) {
  for (glm::vec3& pixel : image.pixels) {
    for (int c = 0; c < 3; ++c) {
      if (!(pixel[c] > 0.0f) || std::isinf(pixel[c])) pixel[c] = 0.0f;
    }
  }
}

// The mean of blocks, so that at most kColumns are left.
EnvironmentImage reduced(const EnvironmentImage& image) {
  const uint32_t factor = (image.width + kColumns - 1) / kColumns;
  if (factor <= 1 || image.height < factor) return image;
  EnvironmentImage out(image.width / factor, image.height / factor);
  for (uint32_t y = 0; y < out.height * factor; ++y) {
    for (uint32_t x = 0; x < out.width * factor; ++x) {
      out.at(x / factor, y / factor) += image.at(x, y) / static_cast<float>(factor * factor);
    }
  }
  return out;
}

std::string lower_case_ending(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

}  // namespace

EnvironmentImage procedural_sky() {
  EnvironmentImage sky(512, 256);
  for (uint32_t y = 0; y < sky.height; ++y) {
    for (uint32_t x = 0; x < sky.width; ++x) {
      sky.at(x, y) = sky_radiance(direction_of((x + 0.5) / sky.width, (y + 0.5) / sky.height));
    }
  }
  return sky;
}

tl::expected<EnvironmentImage, std::string> load_environment(const std::filesystem::path& file) {
  if (file.empty()) return procedural_sky();
  const std::string ending = lower_case_ending(file);
  if (ending != ".hdr" && ending != ".exr") {
    return refuse(file, "give an equirectangular .hdr or .exr file");
  }
  // Opening a pipe that nobody fills waits for ever.
  std::error_code ignored;
  const auto status = std::filesystem::status(file, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    return refuse(file, "it is no regular file");
  }
  Loaded image = ending == ".hdr" ? load_hdr(file) : read_exr_rgb(file);
  if (!image) return image;
  make_light(*image);
  return reduced(*image);
}

glm::vec3 radiance(const EnvironmentImage& environment, const glm::vec3& direction) {
  const auto width = static_cast<int>(environment.width);
  const auto height = static_cast<int>(environment.height);
  float u = std::atan2(direction.x, -direction.z) / glm::two_pi<float>();
  u = u < 0.0f ? u + 1.0f : u;
  const float v = std::acos(std::clamp(direction.y, -1.0f, 1.0f)) / glm::pi<float>();
  const float x = u * static_cast<float>(width) - 0.5f;
  const float y = v * static_cast<float>(height) - 0.5f;
  const float low_x = std::floor(x), low_y = std::floor(y);
  const auto texel = [&](int dx, int dy) {
    const int column = (static_cast<int>(low_x) + dx + width) % width;
    const int row = std::clamp(static_cast<int>(low_y) + dy, 0, height - 1);
    return environment.at(static_cast<uint32_t>(column), static_cast<uint32_t>(row));
  };
  const float s = x - low_x, t = y - low_y;
  return glm::mix(glm::mix(texel(0, 0), texel(1, 0), s), glm::mix(texel(0, 1), texel(1, 1), s), t);
}

glm::vec3 mean_radiance(const EnvironmentImage& environment) {
  glm::dvec3 sum(0.0);
  double weights = 0.0;
  for (uint32_t y = 0; y < environment.height; ++y) {
    const double weight = std::sin((y + 0.5) / environment.height * glm::pi<double>());
    for (uint32_t x = 0; x < environment.width; ++x) {
      sum += glm::dvec3(environment.at(x, y)) * weight;
      weights += weight;
    }
  }
  return sum / weights;
}

}  // namespace alcove::sample
