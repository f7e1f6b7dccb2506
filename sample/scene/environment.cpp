#include "scene/environment.h"

#include <ImfChannelList.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <new>
#include <vector>

#include "support/block_mean.h"
#include "support/foreign_file.h"
#include "support/printable.h"

namespace alcove::sample {
namespace {

constexpr float kLargestHalf = 65504.0f;  // of the 16-bit floats in which the device stores light
constexpr uint32_t kLargestSide = 2048;   // pixels, of an environment in memory

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

// The sides of a window of an OpenEXR file, in pixels.
glm::i64vec2 size_of(const Imath::Box2i& window) {
  return {int64_t{window.max.x} - window.min.x + 1, int64_t{window.max.y} - window.min.y + 1};
}

// Returns the names of the channels of an OpenEXR file.
std::string channel_names(const Imf::Header& header) {
  std::string out;
  for (auto at = header.channels().begin(); at != header.channels().end(); ++at)
    out += (out.empty() ? "" : ", ") + std::string(at.name());
  return shortened(out, 80);
}

// Reads an OpenEXR file, and reduces the image by a whole factor to at most kLargestSide pixels a
// side. The display window is the sphere. Where the file has no data, it is black. The error text
// is the end of a sentence.
Result<EnvironmentImage> read_environment(const std::filesystem::path& file, bool& is_clipped) {
  constexpr int64_t kLargestFileSide = 16384;
  constexpr int kGray = Imf::WRITE_Y;
  try {
    Imf::RgbaInputFile input(file.string().c_str());
    if ((input.channels() & Imf::WRITE_RGB) != Imf::WRITE_RGB && (input.channels() & kGray) == 0) {
      return Failure("has no channels R, G and B, but " + channel_names(input.header()) +
                     "; save it with these three");
    }
    const Imath::Box2i data = input.dataWindow(), window = input.displayWindow();
    const glm::i64vec2 size = size_of(window), data_size = size_of(data);
    const int64_t longest = std::max({size.x, size.y, data_size.x, data_size.y});
    if (longest > kLargestFileSide) {
      return Failure("has more than " + std::to_string(kLargestFileSide) +
                     " pixels a side; save it smaller");
    }
    if (!data.intersects(window))
      return Failure("has no pixels in its display window; crop it again");
    const auto width = static_cast<uint32_t>(size.x), height = static_cast<uint32_t>(size.y);
    const auto factor =
        static_cast<uint32_t>((std::max(size.x, size.y) + kLargestSide - 1) / kLargestSide);
    const Imf::Header& header = input.header();
    const bool is_cube = Imf::hasEnvmap(header) && Imf::envmap(header) == Imf::ENVMAP_CUBE;
    if (is_cube || std::abs(size.x - 2 * size.y) > (size.x + 2 * size.y) / 100) {
      return Failure((is_cube ? "is a cube map of " : "has ") + std::to_string(size.x) + "x" +
                     std::to_string(size.y) +
                     " pixels, and a panorama of the sphere is twice as wide as high; convert cube "
                     "maps and light probes to an equirectangular panorama");
    }
    BlockMean<float, double, 3> mean(width, height, factor);
    EnvironmentImage image(mean.reduced(width), mean.reduced(height));
    size_t written = 0;
    std::vector<Imf::Rgba> row(static_cast<size_t>(data_size.x));
    std::vector<float> light;
    input.setFrameBuffer(row.data() - data.min.x, 1, 0);  // each row into the same memory
    for (int y = window.min.y; y <= window.max.y; ++y) {
      light.assign(size_t{3} * width, 0.0f);
      if (y >= data.min.y && y <= data.max.y) {
        input.readPixels(y);
        for (int x = std::max(data.min.x, window.min.x); x <= std::min(data.max.x, window.max.x);
             ++x) {
          const Imf::Rgba& pixel = row[static_cast<size_t>(x - data.min.x)];
          float* out = &light[3 * static_cast<size_t>(x - window.min.x)];
          for (const float value : {pixel.r, pixel.g, pixel.b}) {
            is_clipped |= value > kLargestHalf;
            *out++ = value > 0.0f ? std::min(value, kLargestHalf) : 0.0f;
          }
        }
      }
      mean.add_row(light, [&](size_t, double value) {
        image.pixels[written / 3][static_cast<int>(written % 3)] = static_cast<float>(value);
        ++written;
      });
    }
    return image;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    std::array<char, 64> start{};
    std::ifstream(file, std::ios::binary).read(start.data(), start.size());
    const auto* bytes = reinterpret_cast<const uint8_t*>(start.data());
    const std::string kind = foreign_kind({bytes, start.size()}, "convert it to OpenEXR");
    if (!kind.empty() && !kind.starts_with("is an OpenEXR")) return Failure(kind);
    return Failure(std::string("is no OpenEXR image that can be read (OpenEXR says: ") +
                   error.what() + "); save it again as a flat image of the channels R, G and B");
  }
}

// Generates a hazy sky over brown ground, brightest towards a low sun. It has no sun disc, because
// that would be direct light. Its mean radiance is about 1.
EnvironmentImage procedural_sky() {
  EnvironmentImage sky(512, 256);
  for (size_t i = 0; i < sky.pixels.size(); ++i) sky.pixels[i] = sky_radiance(direction_at(sky, i));
  return sky;
}

}  // namespace

glm::vec3 direction_at(const EnvironmentImage& environment, size_t pixel) {
  const auto column = static_cast<double>(pixel % environment.width) + 0.5;
  const auto row = static_cast<double>(pixel / environment.width) + 0.5;
  const double angle = column / environment.width * 2.0 * glm::pi<double>();
  const double fall = row / environment.height * glm::pi<double>();
  return glm::vec3(std::sin(fall) * std::sin(angle), std::cos(fall),
                   -std::sin(fall) * std::cos(angle));
}

Result<EnvironmentImage> load_environment(const std::filesystem::path& file,
                                          const std::function<void(const std::string&)>& note) {
  if (file.empty()) return procedural_sky();
  const auto refuse = [&](const std::string& why) {
    return "The environment " + printable(file.string()) + " cannot be used: " + why + ".";
  };
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return Failure(refuse(missing_file(file)));
  bool is_clipped = false;
  auto image = read_environment(file, is_clipped);
  if (!image) return Failure(refuse("it " + image.error()));
  if (is_clipped && note) note("The environment's light above 65504 is clipped to that.");
  return image;
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
