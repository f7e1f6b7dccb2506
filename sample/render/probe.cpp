#include "render/probe.h"

#include <cstring>
#include <utility>
#include <vector>

#include "support/glm.h"

namespace alcove::sample {
namespace {

constexpr passes::EnvironmentSettings kSettings;

// Adds a pass that copies every mip of a transient texture to an image that is kept after the
// frame.
void add_image_copy(Graph& graph, Texture from, const GpuImage& to, std::uint32_t mips) {
  auto pass = graph.add_pass("keep");
  pass.read(from, framegraph::access::transfer_source);
  const Texture filled =
      pass.write(graph.import_texture("kept", to.import_to_fill(kSampledState)),
                 framegraph::access::transfer_destination, {}, framegraph::Contents::discard);
  pass.record([from, filled, mips](RecordContext& context) {
    std::vector<VkImageCopy> copies;
    for (std::uint32_t mip = 0; mip < mips; ++mip) {
      const VkImageSubresourceLayers layers{VK_IMAGE_ASPECT_COLOR_BIT, mip, 0, 1};
      copies.push_back({layers, {}, layers, {}, context.extent(filled, mip)});
    }
    vkCmdCopyImage(context.commands, context.image(from), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                   context.image(filled), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, mips,
                   copies.data());
  });
}

// Adds the passes that compute a probe. `upload` receives the buffer that they read: it must
// outlive the frame.
Result<passes::Environment> add_probe(const passes::Frame& frame, Gpu& gpu,
                                      const EnvironmentImage& image,
                                      std::unique_ptr<HostBuffer>& upload) {
  ALCOVE_TRY(upload, HostBuffer::create(gpu.device(), image.pixels.size() * sizeof(glm::vec4),
                                        VK_BUFFER_USAGE_TRANSFER_SRC_BIT));
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const glm::vec4 texel(image.pixels[i], 1.0f);
    std::memcpy(upload->bytes().data() + i * sizeof(texel), &texel, sizeof(texel));
  }
  const Texture source = frame.graph.create_texture(
      "equirectangular",
      {VK_FORMAT_R32G32B32A32_SFLOAT, framegraph::Extent::absolute(image.width, image.height)});
  return passes::add_environment(frame, add_copy(frame.graph, *upload, source), kSettings)
      .map_error([](const passes::Error& error) { return error.message; });
}

}  // namespace

Result<std::unique_ptr<Probe>> Probe::create(Gpu& gpu, const EnvironmentImage& image) {
  constexpr VkImageUsageFlags kUsage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  std::unique_ptr<Probe> made(new Probe);
  using framegraph::Extent;
  ALCOVE_TRY(made->harmonics_,
             GpuImage::create(gpu.device(), {VK_FORMAT_R32G32B32A32_SFLOAT, Extent::absolute(9, 1)},
                              kUsage));
  ALCOVE_TRY(made->map_,
             GpuImage::create(gpu.device(),
                              {VK_FORMAT_R16G16B16A16_SFLOAT,
                               Extent::absolute(kSettings.size, kSettings.size), kSettings.levels},
                              kUsage));
  std::unique_ptr<HostBuffer> upload;
  ALCOVE_TRY_VOID(gpu.run([&](Graph& graph) -> Result<void> {
    ALCOVE_TRY(const auto light, add_probe({graph, gpu.kernels(), {}}, gpu, image, upload));
    add_image_copy(graph, light.harmonics, *made->harmonics_, 1);
    add_image_copy(graph, light.map, *made->map_, kSettings.levels);
    return {};
  }));
  return made;
}

passes::Environment Probe::import(Graph& graph) const {
  return {graph.import_texture("harmonics", harmonics_->import_to_read(kSampledState)),
          graph.import_texture("environment", map_->import_to_read(kSampledState))};
}

}  // namespace alcove::sample
