#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "gpu/gpu.h"
#include "gpu/gpu_image.h"
#include "render/shaders/gbuffer.h"
#include "scene/scene.h"

namespace alcove::sample {

// Returns how the alpha test reads the base colour: from mip 0, like the ray tracer, so that both
// cut out the same shapes and distant surfaces keep their coverage. It needs a separate sampler,
// because some drivers ignore an explicit mip level with an anisotropic sampler.
[[nodiscard]] TextureUse mask_of(const Material& material);

// The images of a scene in device memory, as its materials use them. There is one descriptor for
// each combination of image, sampler and encoding that occurs, after one for a white texture. Each
// image has all mips down to one texel.
class GpuTextures {
 public:
  // Uploads the images in separate frames.
  [[nodiscard]] static tl::expected<std::unique_ptr<GpuTextures>, std::string> create(
      Gpu& gpu, const Scene& scene);
  ~GpuTextures();
  GpuTextures(const GpuTextures&) = delete;
  GpuTextures& operator=(const GpuTextures&) = delete;

  // Returns the descriptors of a material's textures, in the order of the g-buffer's shaders.
  std::array<VkDescriptorImageInfo, maths::kMaterialTextures> descriptors_of(
      const Material& material) const;

 private:
  struct Use {
    std::int32_t image;
    bool srgb;
    Sampler sampler;
    bool operator==(const Use&) const = default;
  };
  struct Texture {
    std::int32_t image;  // index into Scene::images; -1: white
    bool srgb;
    std::unique_ptr<GpuImage> gpu;
  };

  explicit GpuTextures(const VulkanDevice& device) : device_(device) {}
  tl::expected<void, std::string> add_use(const Scene& scene, const TextureUse& use, bool srgb);
  tl::expected<std::size_t, std::string> add_texture(const Scene& scene, std::int32_t image,
                                                     bool srgb);
  tl::expected<VkSampler, std::string> add_sampler(const Sampler& sampler);
  tl::expected<void, std::string> upload(Gpu& gpu, const Scene& scene);
  // Returns the descriptor of a use that was added. If `srgb` is true, the device decodes sRGB when
  // it reads the texture.
  const VkDescriptorImageInfo& descriptor_of(const TextureUse& use, bool srgb) const;

  const VulkanDevice& device_;
  std::vector<Texture> textures_;
  std::vector<VkSampler> samplers_;
  std::vector<Use> uses_;  // parallel to the descriptors
  std::vector<VkDescriptorImageInfo> descriptors_;
};

}  // namespace alcove::sample
