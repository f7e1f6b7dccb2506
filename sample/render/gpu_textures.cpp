#include "render/gpu_textures.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <utility>

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

constexpr VkImageUsageFlags kUsage =
    VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;

constexpr std::array<uint8_t, 4> kWhite{255, 255, 255, 255};

VkSamplerAddressMode address_mode(Wrap wrap) {
  switch (wrap) {
    case Wrap::kClamp:
      return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    case Wrap::kMirror:
      return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
    default:
      return VK_SAMPLER_ADDRESS_MODE_REPEAT;
  }
}

VkFilter vulkan_filter(Filter filter) {
  return filter == Filter::kNearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
}

std::span<const uint8_t> texels_of(const Scene& scene, std::int32_t image) {
  return image < 0 ? std::span<const uint8_t>(kWhite)
                   : std::span<const uint8_t>(scene.images[static_cast<std::size_t>(image)].rgba);
}

}  // namespace

TextureUse mask_of(const Material& material) {
  TextureUse use = material.base_color_texture;
  use.sampler.minify = use.sampler.magnify;
  use.sampler.mips = MipFilter::kNone;
  return use;
}

tl::expected<std::size_t, std::string> GpuTextures::add_texture(const Scene& scene,
                                                                std::int32_t image, bool srgb) {
  const auto found = std::ranges::find_if(textures_, [&](const Texture& texture) {
    return texture.image == image && texture.srgb == srgb;
  });
  if (found != textures_.end()) {
    return static_cast<std::size_t>(found - textures_.begin());
  }
  VkExtent2D size{1, 1};
  if (image >= 0) {
    const TextureImage& source = scene.images[static_cast<std::size_t>(image)];
    size = {source.width, source.height};
  }
  const uint32_t largest = device_.properties().limits.maxImageDimension2D;
  if (size.width > largest || size.height > largest) {
    return Failure("A texture of " + scene.name + " has " + std::to_string(size.width) + "x" +
                   std::to_string(size.height) + " texels; the device takes at most " +
                   std::to_string(largest) + " a side.");
  }
  // Mips are made by linear blits, which Vulkan guarantees for both formats.
  auto made = GpuImage::create(
      device_,
      {srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM,
       framegraph::Extent::absolute(size.width, size.height),
       static_cast<std::uint32_t>(std::bit_width(std::max(size.width, size.height)))},
      kUsage);
  if (!made) {
    return Failure(std::move(made.error()));
  }
  textures_.push_back({image, srgb, std::move(*made)});
  return textures_.size() - 1;
}

tl::expected<VkSampler, std::string> GpuTextures::add_sampler(const Sampler& sampler) {
  constexpr float kMostAnisotropy = 8.0f;
  // Anisotropic filtering is used only if the file asks for linear filters and mips.
  const bool smooth = sampler.magnify == Filter::kLinear && sampler.minify == Filter::kLinear &&
                      sampler.mips == MipFilter::kLinear;
  const float anisotropy = smooth ? std::min(kMostAnisotropy, device_.max_anisotropy()) : 1.0f;
  const VkSamplerCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
      .magFilter = vulkan_filter(sampler.magnify),
      .minFilter = vulkan_filter(sampler.minify),
      .mipmapMode = sampler.mips == MipFilter::kLinear ? VK_SAMPLER_MIPMAP_MODE_LINEAR
                                                       : VK_SAMPLER_MIPMAP_MODE_NEAREST,
      .addressModeU = address_mode(sampler.wrap_u),
      .addressModeV = address_mode(sampler.wrap_v),
      .addressModeW = VK_SAMPLER_ADDRESS_MODE_REPEAT,
      .anisotropyEnable = anisotropy > 1.0f,
      .maxAnisotropy = anisotropy,
      // With a maxLod of 0.25, a level of detail from 0 to 0.25 is rounded to mip 0. A maxLod of 0
      // would disable the minification filter.
      .maxLod = sampler.mips == MipFilter::kNone ? 0.25f : VK_LOD_CLAMP_NONE};
  VkSampler made = VK_NULL_HANDLE;
  if (const VkResult result = vkCreateSampler(device_.device(), &info, nullptr, &made);
      result != VK_SUCCESS) {
    return device_failure("create a sampler of the scene's textures", result);
  }
  samplers_.push_back(made);
  return made;
}

tl::expected<void, std::string> GpuTextures::add_use(const Scene& scene, const TextureUse& use,
                                                     bool srgb) {
  const Use wanted{use.image, srgb, use.sampler};
  if (std::ranges::find(uses_, wanted) != uses_.end()) {
    return {};
  }
  const auto texture = add_texture(scene, use.image, srgb);
  if (!texture) {
    return Failure(texture.error());
  }
  // Uses with equal samplers share one VkSampler. A linear search is enough, because a scene has
  // few different samplers.
  const auto like = std::ranges::find(uses_, use.sampler, &Use::sampler);
  VkSampler sampler = VK_NULL_HANDLE;
  if (like != uses_.end()) {
    sampler = descriptors_[static_cast<std::size_t>(like - uses_.begin())].sampler;
  } else {
    const auto made = add_sampler(use.sampler);
    if (!made) {
      return Failure(made.error());
    }
    sampler = *made;
  }
  uses_.push_back(wanted);
  descriptors_.push_back(
      {sampler, textures_[*texture].gpu->view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
  return {};
}

tl::expected<void, std::string> GpuTextures::upload(Gpu& gpu, const Scene& scene) {
  // Each texture is uploaded in its own frame, so that only one upload buffer exists at a time.
  for (const Texture& texture : textures_) {
    const auto texels = std::as_bytes(texels_of(scene, texture.image));
    auto source = HostBuffer::create(device_, texels.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    if (!source) {
      return Failure(std::move(source.error()));
    }
    std::ranges::copy(texels, (*source)->bytes().begin());
    const auto declare = [&](framegraph::Graph& graph) -> tl::expected<void, std::string> {
      const auto target =
          graph.import_texture("scene texture", texture.gpu->import_to_fill(kSampledState));
      add_mips(graph, add_copy(graph, **source, target), texture.gpu->mips());
      return {};
    };
    if (auto done = gpu.run(declare); !done) {
      return Failure(std::move(done.error()));
    }
  }
  return {};
}

tl::expected<std::unique_ptr<GpuTextures>, std::string> GpuTextures::create(Gpu& gpu,
                                                                            const Scene& scene) {
  std::unique_ptr<GpuTextures> made(new GpuTextures(gpu.device()));
  auto done = made->add_use(scene, {}, false);
  for (const Material& material : scene.materials) {
    done =
        done.and_then([&] { return made->add_use(scene, material.base_color_texture, true); })
            .and_then([&] { return made->add_use(scene, material.metal_roughness_texture, false); })
            .and_then([&] { return made->add_use(scene, material.emissive_texture, true); })
            .and_then([&] { return made->add_use(scene, material.normal_texture, false); });
    if (material.alpha_mode == AlphaMode::kMask) {
      done = done.and_then([&] { return made->add_use(scene, mask_of(material), true); });
    }
  }
  done = done.and_then([&] { return made->upload(gpu, scene); });
  if (!done) {
    return Failure(std::move(done.error()));
  }
  return made;
}

GpuTextures::~GpuTextures() {
  for (const VkSampler sampler : samplers_) {
    vkDestroySampler(device_.device(), sampler, nullptr);
  }
}

std::array<VkDescriptorImageInfo, maths::kMaterialTextures> GpuTextures::descriptors_of(
    const Material& material) const {
  std::array<VkDescriptorImageInfo, maths::kMaterialTextures> found;
  found.fill(descriptors_.front());
  found[maths::kBaseColourTexture] = descriptor_of(material.base_color_texture, true);
  if (material.alpha_mode == AlphaMode::kMask) {
    found[maths::kMaskTexture] = descriptor_of(mask_of(material), true);
  }
  found[maths::kMetallicRoughnessTexture] = descriptor_of(material.metal_roughness_texture, false);
  found[maths::kEmissiveTexture] = descriptor_of(material.emissive_texture, true);
  found[maths::kNormalTexture] = descriptor_of(material.normal_texture, false);
  return found;
}

const VkDescriptorImageInfo& GpuTextures::descriptor_of(const TextureUse& use, bool srgb) const {
  const Use wanted{use.image, srgb, use.sampler};
  const auto found = std::ranges::find(uses_, wanted);
  return found == uses_.end() ? descriptors_.front()
                              : descriptors_[static_cast<std::size_t>(found - uses_.begin())];
}

}  // namespace alcove::sample
