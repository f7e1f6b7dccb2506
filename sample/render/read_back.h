#pragma once

#include <array>
#include <cstdint>
#include <cstring>

#include "alcove/passes/frame.h"
#include "gpu/gpu.h"
#include "support/image.h"

// Converts buffers into which the device copied textures to images.
namespace alcove::sample {

// Converts a read-back buffer to an image, with one call of `convert` for each texel.
template <typename Pixel, typename Texel, typename Convert>
Image<Pixel> to_image(const HostBuffer& buffer, VkExtent2D size, Convert convert) {
  Image<Pixel> image(size.width, size.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    Texel texel;
    std::memcpy(&texel, buffer.bytes().data() + i * sizeof(Texel), sizeof(Texel));
    image.pixels[i] = convert(texel);
  }
  return image;
}

using Half4 = std::array<std::uint16_t, 4>;
using Byte4 = std::array<std::uint8_t, 4>;
using SignedByte4 = std::array<std::int8_t, 4>;

inline glm::vec3 from_half(const Half4& texel) {
  return {half_to_float(texel[0]), half_to_float(texel[1]), half_to_float(texel[2])};
}

inline glm::vec3 from_bytes(const Byte4& texel) {
  return glm::vec3(texel[0], texel[1], texel[2]) / 255.0f;
}

// Returns the bytes per texel of a format that is read back.
inline std::uint32_t texel_bytes(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R8_UNORM:
      return 1;
    case VK_FORMAT_R16_SFLOAT:
      return 2;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
      return 8;
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return 16;
    default:
      return 4;
  }
}

// Converts visibility that a pass wrote with this precision to floats.
inline Image<float> read_visibility(const HostBuffer& buffer, VkExtent2D size,
                                    passes::Precision precision) {
  switch (precision) {
    case passes::Precision::unorm8:
      return to_image<float, std::uint8_t>(buffer, size,
                                           [](std::uint8_t x) { return float(x) / 255.0f; });
    case passes::Precision::float16:
      return to_image<float, std::uint16_t>(buffer, size, half_to_float);
    default:
      return to_image<float, float>(buffer, size, [](float x) { return x; });
  }
}

inline Image<glm::vec3> read_vectors(const HostBuffer& buffer, VkExtent2D size,
                                     passes::Precision precision) {
  switch (precision) {
    case passes::Precision::unorm8:
      return to_image<glm::vec3, SignedByte4>(buffer, size, [](const SignedByte4& t) {
        return glm::normalize(glm::vec3(t[0], t[1], t[2]) / 127.0f);
      });
    case passes::Precision::float16:
      return to_image<glm::vec3, Half4>(buffer, size, from_half);
    default:
      return to_image<glm::vec3, glm::vec4>(buffer, size,
                                            [](const glm::vec4& t) { return glm::vec3(t); });
  }
}

inline Image<glm::vec3> read_colours(const HostBuffer& buffer, VkExtent2D size,
                                     passes::Precision precision) {
  if (precision == passes::Precision::unorm8) {
    return to_image<glm::vec3, Byte4>(buffer, size, from_bytes);
  }
  return read_vectors(buffer, size, precision);
}

}  // namespace alcove::sample
