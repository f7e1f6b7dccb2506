#include "render/gpu_textures.h"

#include <algorithm>
#include <span>
#include <utility>

namespace alcove::sample {
namespace {

constexpr std::array<std::uint8_t, 4> kWhite{255, 255, 255, 255};

VkSamplerAddressMode address_mode(Wrap wrap) {
  switch (wrap) {
    case Wrap::clamp:
      return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    case Wrap::mirror:
      return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
    default:
      return VK_SAMPLER_ADDRESS_MODE_REPEAT;
  }
}

VkFilter vulkan_filter(Filter filter) {
  return filter == Filter::nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
}

}  // namespace

std::array<GpuTextures::Use, maths::kMaterialTextures> GpuTextures::texture_uses(
    const Material& material) {
  const auto use = [](const TextureUse& texture, bool srgb) {
    return Use{texture.image, srgb, texture.sampler};
  };
  std::array<Use, maths::kMaterialTextures> uses;
  uses[maths::kBaseColourTexture] = use(material.base_color_texture, true);
  uses[maths::kMetallicRoughnessTexture] = use(material.metal_roughness_texture, false);
  uses[maths::kEmissiveTexture] = use(material.emissive_texture, true);
  uses[maths::kNormalTexture] = use(material.normal_texture, false);
  if (material.alpha_mode == AlphaMode::mask) {
    // The alpha test reads the base colour from mip 0, like the ray tracer, so that both cut out
    // the same shapes and distant surfaces keep their coverage. It needs a separate sampler,
    // because some drivers ignore an explicit mip level with an anisotropic sampler.
    Use& mask = uses[maths::kMaskTexture];
    mask = uses[maths::kBaseColourTexture];
    mask.sampler.minify = mask.sampler.magnify;
    mask.sampler.mips = MipFilter::none;
  }
  return uses;
}

Result<VkImageView> GpuTextures::add_texture(const Scene& scene, const Use& use) {
  const auto found = std::ranges::find_if(textures_, [&](const Texture& texture) {
    return texture.image == use.image && texture.srgb == use.srgb;
  });
  if (found != textures_.end()) return found->gpu->view();
  VkExtent2D size{1, 1};
  std::span<const std::byte> texels = std::as_bytes(std::span(kWhite));
  if (use.image >= 0) {
    const TextureImage& source = scene.images[static_cast<std::size_t>(use.image)];
    size = {source.width, source.height};
    texels = std::as_bytes(std::span(source.rgba));
  }
  const std::uint32_t largest = gpu_.device().properties().limits.maxImageDimension2D;
  if (size.width > largest || size.height > largest) {
    return Failure("A texture of " + scene.name + " has " + std::to_string(size.width) + "x" +
                   std::to_string(size.height) + " texels; the device takes at most " +
                   std::to_string(largest) + " a side.");
  }
  // Mips are made by linear blits, which Vulkan guarantees for both formats.
  const VkFormat format = use.srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
  ALCOVE_TRY(auto image, upload_image(gpu_, format, size, texels));
  textures_.push_back({use.image, use.srgb, std::move(image)});
  return textures_.back().gpu->view();
}

Result<VkSampler> GpuTextures::add_sampler(const Sampler& sampler) {
  constexpr float kMostAnisotropy = 8.0f;
  // Anisotropic filtering is used only if the file asks for linear filters and mips.
  const bool smooth = sampler.magnify == Filter::linear && sampler.minify == Filter::linear &&
                      sampler.mips == MipFilter::linear;
  const float anisotropy =
      smooth ? std::min(kMostAnisotropy, gpu_.device().max_anisotropy()) : 1.0f;
  const VkSamplerCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
      .magFilter = vulkan_filter(sampler.magnify),
      .minFilter = vulkan_filter(sampler.minify),
      .mipmapMode = sampler.mips == MipFilter::linear ? VK_SAMPLER_MIPMAP_MODE_LINEAR
                                                      : VK_SAMPLER_MIPMAP_MODE_NEAREST,
      .addressModeU = address_mode(sampler.wrap_u),
      .addressModeV = address_mode(sampler.wrap_v),
      .addressModeW = VK_SAMPLER_ADDRESS_MODE_REPEAT,
      .anisotropyEnable = anisotropy > 1.0f,
      .maxAnisotropy = anisotropy,
      // With a maxLod of 0.25, a level of detail from 0 to 0.25 is rounded to mip 0. A maxLod of 0
      // would disable the minification filter.
      .maxLod = sampler.mips == MipFilter::none ? 0.25f : VK_LOD_CLAMP_NONE};
  VkSampler made = VK_NULL_HANDLE;
  if (const VkResult result = vkCreateSampler(gpu_.device().device(), &info, nullptr, &made);
      result != VK_SUCCESS)
    return device_failure("create a sampler of the scene's textures", result);
  samplers_.push_back(made);
  return made;
}

Result<void> GpuTextures::add_use(const Scene& scene, const Use& use) {
  if (std::ranges::find(uses_, use) != uses_.end()) return {};
  // Uses with equal samplers share one VkSampler. A linear search is enough, because a scene has
  // few different samplers.
  VkDescriptorImageInfo descriptor{.imageLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  ALCOVE_TRY(descriptor.imageView, add_texture(scene, use));
  const auto like = std::ranges::find(uses_, use.sampler, &Use::sampler);
  if (like != uses_.end()) {
    descriptor.sampler = descriptors_[static_cast<std::size_t>(like - uses_.begin())].sampler;
  } else {
    ALCOVE_TRY(descriptor.sampler, add_sampler(use.sampler));
  }
  uses_.push_back(use);
  descriptors_.push_back(descriptor);
  return {};
}

Result<std::unique_ptr<GpuTextures>> GpuTextures::create(Gpu& gpu, const Scene& scene) {
  std::unique_ptr<GpuTextures> made(new GpuTextures(gpu));
  for (const Material& material : scene.materials)
    for (const Use& use : texture_uses(material)) ALCOVE_TRY_VOID(made->add_use(scene, use));
  return made;
}

GpuTextures::~GpuTextures() {
  for (const VkSampler sampler : samplers_)
    vkDestroySampler(gpu_.device().device(), sampler, nullptr);
}

std::array<VkDescriptorImageInfo, maths::kMaterialTextures> GpuTextures::descriptors_of(
    const Material& material) const {
  std::array<VkDescriptorImageInfo, maths::kMaterialTextures> found;
  std::ranges::transform(texture_uses(material), found.begin(), [&](const Use& use) {
    const auto at = std::ranges::find(uses_, use);
    return descriptors_[static_cast<std::size_t>(at - uses_.begin())];
  });
  return found;
}

}  // namespace alcove::sample
