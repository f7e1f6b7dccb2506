#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "gpu/gpu.h"
#include "gpu/gpu_image.h"
#include "render/shaders/gbuffer.h"
#include "scene/scene.h"
#include "support/result.h"

namespace alcove::sample {

// The images of a scene in device memory, as its materials use them. There is one descriptor for
// each combination of image, sampler and encoding that occurs. Each image has all mips down to one
// texel.
class GpuTextures {
 public:
  // Uploads the images in separate frames, so that only one upload buffer exists at a time.
  [[nodiscard]] static Result<std::unique_ptr<GpuTextures>> create(Gpu& gpu, const Scene& scene);
  ~GpuTextures();
  GpuTextures(const GpuTextures&) = delete;
  GpuTextures& operator=(const GpuTextures&) = delete;

  // Returns the descriptors of a material's textures, in the order of the g-buffer's shaders.
  std::array<VkDescriptorImageInfo, maths::kMaterialTextures> descriptors_of(
      const Material& material) const;

 private:
  // How a shader reads an image. By default it reads white.
  struct Use {
    std::int32_t image = -1;  // index into Scene::images; -1: white
    bool srgb = false;        // the device decodes sRGB
    Sampler sampler;
    bool operator==(const Use&) const = default;
  };
  struct Texture {
    std::int32_t image;
    bool srgb;
    std::unique_ptr<GpuImage> gpu;
  };

  explicit GpuTextures(Gpu& gpu) : gpu_(gpu) {}
  // Returns the uses of a material's textures, in the order of the g-buffer's shaders.
  static std::array<Use, maths::kMaterialTextures> texture_uses(const Material& material);
  Result<void> add_use(const Scene& scene, const Use& use);
  Result<VkImageView> add_texture(const Scene& scene, const Use& use);
  Result<VkSampler> add_sampler(const Sampler& sampler);

  Gpu& gpu_;
  std::vector<Texture> textures_;
  std::vector<VkSampler> samplers_;
  std::vector<Use> uses_;  // parallel to the descriptors
  std::vector<VkDescriptorImageInfo> descriptors_;
};

}  // namespace alcove::sample
