#include "render/read_back.h"

#include <array>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <utility>

namespace alcove::sample {
namespace {

// A format that is read back: its channels, and the bytes of a channel.
struct Format {
  std::uint32_t channels;
  std::uint32_t bytes;
};

Format format_layout(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R8_UNORM:
      return {1, 1};
    case VK_FORMAT_R16_SFLOAT:
      return {1, 2};
    case VK_FORMAT_R16G16B16A16_SFLOAT:
      return {4, 2};
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return {4, 4};
    case VK_FORMAT_R32_SFLOAT:
    case VK_FORMAT_D32_SFLOAT:
      return {1, 4};
    default:  // four channels of 8 bits
      return {4, 1};
  }
}

template <typename Number>
Number read(const std::byte* data) {
  Number value;
  std::memcpy(&value, data, sizeof(value));
  return value;
}

float read_channel(const std::byte* data, std::uint32_t bytes, bool is_signed) {
  switch (bytes) {
    case 1:
      return is_signed ? float(read<std::int8_t>(data)) / 127.0f
                       : float(read<std::uint8_t>(data)) / 255.0f;
    case 2:
      return glm::unpackHalf1x16(read<std::uint16_t>(data));
    default:
      return read<float>(data);
  }
}

Texels read_texels(const std::byte* all, VkExtent3D size, VkFormat format, VkExtent2D border) {
  const auto [channels, bytes] = format_layout(format);
  Texels texels(size.width - 2 * border.width, size.height - 2 * border.height);
  for (std::uint32_t y = 0; y < texels.height; ++y) {
    const std::size_t first = std::size_t{y + border.height} * size.width + border.width;
    const std::byte* data = all + first * channels * bytes;
    for (std::uint32_t x = 0; x < texels.width; ++x) {
      glm::vec4& texel = texels.at(x, y);
      for (std::uint32_t c = 0; c < channels; ++c, data += bytes)
        texel[static_cast<int>(c)] = read_channel(data, bytes, format == VK_FORMAT_R8G8B8A8_SNORM);
      if (format == VK_FORMAT_B8G8R8A8_UNORM) std::swap(texel.r, texel.b);
    }
  }
  return texels;
}

}  // namespace

void ReadBack::add(framegraph::Graph& graph, framegraph::Texture texture,
                   std::function<void(const Texels&)> store) {
  if (!texture || !added_) return;
  Copy copy{
      .format = graph.format(texture), .size = graph.extent(texture), .store = std::move(store)};
  const auto [channels, bytes] = format_layout(copy.format);
  const VkDeviceSize total = VkDeviceSize{copy.size.width} * copy.size.height * channels * bytes;
  auto buffer = HostBuffer::create(device_, total, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  if (!buffer) {
    added_ = Failure(std::move(buffer.error()));
    return;
  }
  add_read_back(graph, texture, **buffer);
  copy.buffer = std::move(*buffer);
  copies_.push_back(std::move(copy));
}

void ReadBack::finish() const {
  for (const Copy& copy : copies_)
    copy.store(read_texels(copy.buffer->bytes().data(), copy.size, copy.format, border_));
}

Image<float> channel(const Texels& texels, int index) {
  Image<float> image(texels.width, texels.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = texels.pixels[i][index];
  return image;
}

Image<glm::vec3> rgb(const Texels& texels) {
  Image<glm::vec3> image(texels.width, texels.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = texels.pixels[i];
  return image;
}

}  // namespace alcove::sample
