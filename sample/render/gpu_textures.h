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

// How a mask reads its base colour: mip 0, as the ray tracer does, so that both cut out the same
// and what is far keeps its coverage. By a sampler of its own, since not every driver takes a given
// mip from an anisotropic one.
[[nodiscard]] TextureUse mask_of(const Material& material);

// The images of a scene on the device as its materials use them: one descriptor for each image,
// sampler and encoding that occurs, after a white one. Mips go down to one texel.
class GpuTextures {
 public:
  // Uploads through frames of its own.
  [[nodiscard]] static tl::expected<std::unique_ptr<GpuTextures>, std::string> create(
      Gpu& gpu, const Scene& scene);
  ~GpuTextures();
  GpuTextures(const GpuTextures&) = delete;
  GpuTextures& operator=(const GpuTextures&) = delete;

  // The descriptors of one of the scene's materials, in the order of the g-buffer's shaders.
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
    std::int32_t image;  // -1: white
    bool srgb;
    std::unique_ptr<GpuImage> gpu;
  };

  explicit GpuTextures(const VulkanDevice& device) : device_(device) {}
  tl::expected<void, std::string> add_use(const Scene& scene, const TextureUse& use, bool srgb);
  tl::expected<std::size_t, std::string> add_texture(const Scene& scene, std::int32_t image,
                                                     bool srgb);
  tl::expected<VkSampler, std::string> add_sampler(const Sampler& sampler);
  tl::expected<void, std::string> upload(Gpu& gpu, const Scene& scene);
  // Of a use that was added. `srgb` is decoded by the device as it is read.
  const VkDescriptorImageInfo& descriptor_of(const TextureUse& use, bool srgb) const;

  const VulkanDevice& device_;
  std::vector<Texture> textures_;
  std::vector<VkSampler> samplers_;
  std::vector<Use> uses_;  // parallel to the descriptors
  std::vector<VkDescriptorImageInfo> descriptors_;
};

}  // namespace alcove::sample
