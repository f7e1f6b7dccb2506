#include "render/read_back.h"

#include <utility>

namespace alcove::sample {
namespace {

Texels read_texels(const std::byte* all, VkExtent3D size, VkFormat format, VkExtent2D border) {
  const TexelLayout layout = texel_layout(format);
  Texels texels(size.width - 2 * border.width, size.height - 2 * border.height);
  for (std::uint32_t y = 0; y < texels.height; ++y) {
    const std::size_t first = std::size_t{y + border.height} * size.width + border.width;
    const std::byte* data = all + first * layout.channels * layout.bytes;
    for (std::uint32_t x = 0; x < texels.width; ++x) {
      glm::vec4& texel = texels.at(x, y);
      for (std::uint32_t c = 0; c < layout.channels; ++c, data += layout.bytes)
        texel[static_cast<int>(c)] = read_channel(data, layout);
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
  const TexelLayout layout = texel_layout(copy.format);
  const VkDeviceSize total =
      VkDeviceSize{copy.size.width} * copy.size.height * layout.channels * layout.bytes;
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
  return mapped([index](const glm::vec4& texel) { return texel[index]; }, texels);
}

Image<glm::vec3> rgb(const Texels& texels) {
  return mapped([](const glm::vec4& texel) { return glm::vec3(texel); }, texels);
}

}  // namespace alcove::sample
