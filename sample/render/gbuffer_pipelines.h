#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <tl/expected.hpp>

#include "gpu/vulkan_device.h"

namespace alcove::sample {

// The g-buffer's pipelines on a device, and the layouts of their descriptor sets. The pipelines
// write depth, and also normal, albedo, motion and emission if these targets are attached.
class GbufferPipelines {
 public:
  // The targets of a pipeline: all targets of the g-buffer, or only the depth of the second layer.
  enum class Kind : std::uint8_t { all, second_layer };

  // `device` must outlive the pipelines.
  [[nodiscard]] static tl::expected<std::unique_ptr<GbufferPipelines>, std::string> create(
      VkDevice device, bool geometric_normals);
  ~GbufferPipelines();
  GbufferPipelines(const GbufferPipelines&) = delete;
  GbufferPipelines& operator=(const GbufferPipelines&) = delete;

  // Returns a pipeline. `reversed` means that nearer surfaces have greater depths. Viewport,
  // scissor, cull mode, front face and the strides of the vertex streams are dynamic state.
  [[nodiscard]] VkPipeline pipeline(Kind kind, bool reversed) const {
    return pipelines_[index_of(kind, reversed)];
  }
  [[nodiscard]] VkPipelineLayout layout() const { return layout_; }
  // Set 0: the frame's parameters, a uniform buffer with a dynamic offset.
  [[nodiscard]] VkDescriptorSetLayout frame_set() const { return frame_set_; }
  // Set 1, only for the second layer: the depth of the first layer.
  [[nodiscard]] VkDescriptorSetLayout layer_set() const { return layer_set_; }
  // Returns the layout of descriptor set 2: the textures and the parameters of a material. Each
  // material has its own descriptor set, because few devices allow hundreds of textures in one set.
  [[nodiscard]] VkDescriptorSetLayout material_set() const { return material_set_; }

 private:
  explicit GbufferPipelines(VkDevice device) : device_(device) {}
  static std::size_t index_of(Kind kind, bool reversed) {
    return (kind == Kind::second_layer ? 2 : 0) + (reversed ? 1 : 0);
  }
  VkResult create_layout();
  VkResult create_pipelines(Kind kind, bool geometric_normals);

  VkDevice device_;
  VkDescriptorSetLayout frame_set_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout layer_set_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout material_set_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  std::array<VkPipeline, 4> pipelines_{};
};

// The stages that read parameters of the frame and of materials.
inline constexpr VkShaderStageFlags kDrawStages =
    VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

}  // namespace alcove::sample
